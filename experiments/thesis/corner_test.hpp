#pragma once

#include <array>
#include <string_view>

namespace kairos::experiments::thesis {

/// An axis-aligned box in the plane as 2.1.2 writes it: its bottom left corner and two lengths.
struct FlatBox {
  double x = 0.0, y = 0.0;    ///< bottom left corner, m
  double dx = 0.0, dy = 0.0;  ///< lengths, m
};

/// A test whether two boxes overlap.
struct FlatTest {
  std::string_view name;
  std::string_view meaning;
  bool (*overlap)(const FlatBox& c, const FlatBox& d);
};

/// 2.1.2's test and what could be meant by it, from its printed text to the full test:
///   printed     the code as printed: its last comparison is `yd < yd + dy`, which is always true
///   corner      what must have been meant: the bottom left corner of C lies inside D
///   corners     "similar segments ... to test all four corners" of C
///   both        the corners of either box inside the other
///   intervals   the boxes overlap along both axes (what figs. 2 and 3 say in words)
///   library     the separating axes of the library, on boxes of the same thickness
[[nodiscard]] const std::array<FlatTest, 6>& flat_tests();

}  // namespace kairos::experiments::thesis
