#include "core/frame_times.hpp"

#include "core/error.hpp"
#include "core/reading/frame_reader.hpp"
#include "tests/catch.hpp"
#include "tests/temporary_folder.hpp"

using namespace kairos;

TEST_CASE("durations: numbers, units, fractions", "[frames]") {
  CHECK(parse_duration("0.02") == 0.02);
  CHECK(parse_duration("0.02s") == 0.02);
  CHECK(parse_duration("16ms") == 0.016);
  CHECK(parse_duration("250us") == 0.00025);
  CHECK(parse_duration("5 ns") == 5e-9);
  CHECK(parse_duration("1/60") == 1.0 / 60.0);
  CHECK(parse_duration(" 1/60 s ") == 1.0 / 60.0);
  CHECK(parse_duration("2.5/3") == 2.5 / 3.0);
  for (const char* text : {"", "s", "0", "-1", "1/0", "1/-2", "1//2", "/2", "1/", "nan", "inf",
                           "1e13", "1e-400", "1m", "1/2/3", "ms"}) {
    INFO(text);
    CHECK_THROWS_AS(parse_duration(text), InputError);
  }
}

TEST_CASE("frames: fixed and listed ones", "[frames]") {
  CHECK(frame_duration(FixedFrames{0.25}, 1000000) == 0.25);
  const FrameTimes listed = ListedFrames{{0.1, 0.2, 0.3}, ""};
  CHECK(frame_duration(listed, 0) == 0.1);
  CHECK(frame_duration(listed, 2) == 0.3);
  CHECK(frame_duration(listed, 4) == 0.2);
  CHECK(mean_frame_duration(listed) == Approx(0.2).epsilon(1e-15));
}

TEST_CASE("frames: jitter and stalls are pure functions of the frame, with the mean they declare",
          "[frames]") {
  const JitteredFrames frames{0.02, 0.5, 0.05, 10.0, 42};
  double sum = 0.0;
  int stalls = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double h = frame_duration(frames, i);
    REQUIRE(h == frame_duration(frames, i));
    const bool stall = h > 0.05;
    stalls += stall ? 1 : 0;
    const double plain = stall ? h / 10.0 : h;
    REQUIRE(plain >= 0.01);
    REQUIRE(plain <= 0.03);
    sum += h;
  }
  // Five standard deviations: of a stall count, and of the mean they dominate.
  CHECK(std::abs(stalls - 0.05 * n) < 5.0 * std::sqrt(0.05 * 0.95 * n));
  CHECK(std::abs(sum / n - mean_frame_duration(frames)) < 5.0 * 0.18 * 0.25 / std::sqrt(n));
  const JitteredFrames other{0.02, 0.5, 0.05, 10.0, 43};
  CHECK(frame_duration(frames, 0) != frame_duration(other, 0));
}

TEST_CASE("frames: a CSV with and without a header", "[frames]") {
  const tests::TemporaryFolder folder;
  const auto read = [&folder](const std::string& text) {
    return std::get<ListedFrames>(read_frame_csv(folder.file("frames.csv", text))).durations;
  };
  CHECK(read("0.1\n0.2\n\n# a stall\n1\n") == std::vector<double>{0.1, 0.2, 1.0});
  CHECK(read("index,duration\r\n0,0.1\r\n1,0.2") == std::vector<double>{0.1, 0.2});
}
