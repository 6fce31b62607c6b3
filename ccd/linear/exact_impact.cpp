// Stage 4: yes or no, and when, in whole numbers; equation numbers are those of the README.
#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/exact_root.hpp"

#include <optional>

namespace kairos::ccd {
namespace {

/// Three polynomials of a vertex and a face, or four of two edges.
struct Several {
  std::array<ExactPolynomial, 4> p;
  std::size_t size = 0;

  [[nodiscard]] const ExactPolynomial* begin() const { return p.data(); }
  [[nodiscard]] const ExactPolynomial* end() const { return p.data() + size; }
};

ExactPolynomial negative(ExactPolynomial p) {
  p.negate();
  return p;
}

class Contact {
 public:
  Contact(LinearKind kind, const ExactMotion& motion) : kind_(kind), motion_(motion) {}

  /// Equations (3) and (4): where the volume is zero they meet if, for one k, not all are zero and
  /// none has the sign opposite to another's.
  const Several& weights(std::size_t k) {
    if (!weights_[k]) {
      const ExactPolynomial u = cross(motion_.y(), motion_.z(), k);
      const ExactPolynomial v = cross(motion_.x(), motion_.z(), k);
      const ExactPolynomial w = cross(motion_.x(), motion_.y(), k);
      if (kind_ == LinearKind::vertex_face) {
        weights_[k] = Several{{u, negative(v), w, {}}, 3};
      } else {
        weights_[k] = Several{{u, v - w - u, v, negative(w)}, 4};
      }
    }
    return *weights_[k];
  }
  /// Equation (5): on a line, they are apart if for one k all have the same sign.
  [[nodiscard]] Several differences(std::size_t k) const {
    const ExactPolynomial x = motion_.x().component(k);
    const ExactPolynomial y = motion_.y().component(k);
    const ExactPolynomial z = motion_.z().component(k);
    return kind_ == LinearKind::vertex_face ? Several{{x, y, z, {}}, 3}
                                            : Several{{y, z, y - x, z - x}, 4};
  }

  /// At a root, where the volume is zero.
  bool at(ExactRoots& roots, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Signs signs = signs_of(weights(k), roots, i);
      if (signs.opposite()) {
        return false;
      }
      if (signs.positive || signs.negative) {
        return true;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Signs signs = signs_of(differences(k), roots, i);
      if (!signs.zero && !signs.opposite()) {
        return false;
      }
    }
    return true;
  }

 private:
  struct Signs {
    bool positive = false, negative = false, zero = false;
    [[nodiscard]] bool opposite() const { return positive && negative; }
  };
  static Signs signs_of(const Several& polynomials, ExactRoots& roots, std::size_t i) {
    Signs signs;
    for (const ExactPolynomial& p : polynomials) {
      const int sign = roots.sign_at(i, p);
      signs.positive |= sign > 0;
      signs.negative |= sign < 0;
      signs.zero |= sign == 0;
      if (signs.opposite()) {
        break;
      }
    }
    return signs;
  }

  LinearKind kind_;
  const ExactMotion& motion_;
  std::array<std::optional<Several>, 3> weights_;
};

/// Takes a meeting at a root of p that is earlier than the one known.
void look_at_roots(const ExactPolynomial& p, Contact& contact, LinearImpact& first) {
  if (p.degree() < 1) {
    return;
  }
  ExactRoots roots(p);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const ExactRoot& root = roots.refined(i);
    if (root.t_lo > first.t_lo || (root.t_lo == first.t_lo && root.t_hi >= first.t_hi)) {
      return;
    }
    if (contact.at(roots, i)) {
      first = {true, root.t_lo, root.t_hi, LinearStage::integers};
      return;
    }
  }
}

/// Always coplanar: they first meet at the start, or where a condition begins to hold.
void look_at_coplanar(Contact& contact, LinearImpact& first) {
  look_at_roots(ExactPolynomial(0, 1), contact, first);
  if (first.hit) {
    return;
  }
  bool always_on_a_line = true;
  for (std::size_t k = 0; k < 3 && always_on_a_line; ++k) {
    for (const ExactPolynomial& p : contact.weights(k)) {
      always_on_a_line &= p.is_zero();
      look_at_roots(p, contact, first);
    }
  }
  for (std::size_t k = 0; k < 3 && always_on_a_line; ++k) {
    for (const ExactPolynomial& p : contact.differences(k)) {
      look_at_roots(p, contact, first);
    }
  }
}

}  // namespace

LinearImpact exact_impact(const LinearQuery& query) {
  const ExactMotion motion(query, AxisUnits::own);
  const ExactPolynomial volume = motion.volume();
  Contact contact(query.kind, motion);
  LinearImpact first;
  first.stage = LinearStage::integers;
  if (volume.is_zero()) {
    look_at_coplanar(contact, first);
  } else {
    look_at_roots(volume, contact, first);
  }
  return first;
}

}  // namespace kairos::ccd
