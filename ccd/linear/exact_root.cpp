#include "ccd/linear/exact_root.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace kairos::ccd {
namespace {

// Doubles that are not negative, counted: the next one is the next number.
std::int64_t ordinal(double x) { return std::bit_cast<std::int64_t>(x); }
double from_ordinal(std::int64_t n) { return std::bit_cast<double>(n); }

/// Where the one root between lower and upper may be, in doubles: a place to start from.
double approximate_root(const ExactPolynomial& p, double lower, double upper, int sign_before) {
  int top = std::numeric_limits<int>::min();
  for (int i = 0; i <= p.degree(); ++i) {
    top = std::max(top, p[i].bit_length());
  }
  std::array<double, ExactPolynomial::highest_degree + 1> c{};
  for (int i = 0; i <= p.degree(); ++i) {
    c[static_cast<std::size_t>(i)] = sign_before * p[i].scaled(top);
  }
  double t = 0.5 * (lower + upper);
  for (int i = 0; i < 64; ++i) {
    double value = 0.0;
    double slope = 0.0;
    for (int k = p.degree(); k >= 0; --k) {
      slope = slope * t + value;
      value = value * t + c[static_cast<std::size_t>(k)];
    }
    (value > 0.0 ? lower : upper) = t;
    double next = t - value / slope;
    if (!(next > lower && next < upper)) {
      next = 0.5 * (lower + upper);
    }
    if (std::abs(next - t) <= 0x1p-52 * t) {
      return next;
    }
    t = next;
  }
  return t;
}

struct Part {
  Dyadic lower, upper;
  Variations found;
};

}  // namespace

ExactRoots::ExactRoots(const ExactPolynomial& p) : p_(p) {
  const Dyadic zero(0.0);
  const Dyadic one(1.0);
  const Variations whole = variations(p_, zero, one);
  if (p_[0].is_zero()) {
    add(zero, zero, 0);
  }
  if (whole.count == 1) {
    add(zero, one, whole.first);
  } else if (whole.count > 1) {
    p_ = square_free_part(p_);
    isolate(variations(p_, zero, one));
  }
  if (p_.sign_at(one) == 0) {
    add(one, one, 0);
  }
}

void ExactRoots::add(const Dyadic& lower, const Dyadic& upper, int sign_before) {
  assert(size_ < roots_.size());
  ExactRoot& root = roots_[size_++];
  root.lower = lower;
  root.upper = upper;
  root.sign_before = sign_before;
}

// Halves until no part has more than one change of sign: it ends, as all roots are simple. Parts
// side by side have no more changes together than the whole: those that wait are few.
void ExactRoots::isolate(const Variations& whole) {
  std::array<Part, 2 * largest_degree> waiting;
  std::size_t count = 0;
  const auto wait = [&](const Dyadic& lower, const Dyadic& upper, const Variations& found) {
    if (found.count > 0 || found.first == 0) {
      waiting[count++] = {lower, upper, found};
    }
  };
  wait(Dyadic(0.0), Dyadic(1.0), whole);
  while (count > 0) {
    const Part part = std::move(waiting[--count]);
    if (part.found.count <= 1) {
      add(part.lower, part.upper, part.found.first);
      continue;
    }
    const Dyadic half = middle(part.lower, part.upper);
    wait(half, part.upper, variations(p_, half, part.upper));
    if (p_.sign_at(half) == 0) {
      wait(half, half, {});
    }
    wait(part.lower, half, variations(p_, part.lower, half));
  }
}

const ExactRoot& ExactRoots::refined(std::size_t i) {
  if (!is_refined_[i]) {
    refine(roots_[i]);
    is_refined_[i] = true;
  }
  return roots_[i];
}

void ExactRoots::refine(ExactRoot& root) const {
  root.t_lo = rounded_down(root.lower);
  root.t_hi = rounded_down(root.upper);
  if (root.sign_before == 0) {  // a number; more than a double holds, if it was found by halving
    if (compare(Dyadic(root.t_lo), root.lower) != 0) {
      root.t_hi = std::nextafter(root.t_lo, 1.0);
    }
    return;
  }
  if (compare(Dyadic(root.t_hi), root.upper) != 0) {
    root.t_hi = std::nextafter(root.t_hi, 1.0);
  }
  std::int64_t low = ordinal(root.t_lo);
  std::int64_t high = ordinal(root.t_hi);
  std::int64_t candidate = ordinal(approximate_root(p_, root.t_lo, root.t_hi, root.sign_before));
  for (std::int64_t stride = 1; high - low > 1;
       stride *= stride < (std::int64_t{1} << 55) ? 4 : 1) {
    if (candidate <= low || candidate >= high) {
      candidate = low + (high - low) / 2;
    }
    Dyadic t(from_ordinal(candidate));
    int sign = root.sign_before;
    if (compare(t, root.lower) > 0) {
      sign = compare(t, root.upper) >= 0 ? -root.sign_before : p_.sign_at(t);
      if (sign == 0) {
        root.upper = t;
        root.lower = std::move(t);
        root.sign_before = 0;
        low = high = candidate;
        break;
      }
      if (compare(t, root.upper) < 0) {
        (sign == root.sign_before ? root.lower : root.upper) = std::move(t);
      }
    }
    (sign == root.sign_before ? low : high) = candidate;
    candidate = sign == root.sign_before ? low + stride : high - stride;
  }
  root.t_lo = from_ordinal(low);
  root.t_hi = from_ordinal(high);
}

void ExactRoots::leave_ends_that_are_roots(ExactRoot& root) const {
  while (p_.sign_at(root.lower) == 0 || p_.sign_at(root.upper) == 0) {
    Dyadic half = middle(root.lower, root.upper);
    const int sign = p_.sign_at(half);
    if (sign == 0) {
      root.upper = half;
      root.lower = std::move(half);
      root.sign_before = 0;
      return;
    }
    (sign == root.sign_before ? root.lower : root.upper) = std::move(half);
  }
}

int ExactRoots::sign_at(std::size_t i, const ExactPolynomial& q) {
  if (q.is_zero()) {
    return 0;
  }
  static_cast<void>(refined(i));
  ExactRoot& root = roots_[i];
  if (root.sign_before != 0) {
    const Variations within = variations(q, root.lower, root.upper);
    if (within.count == 0) {
      return within.first;
    }
    leave_ends_that_are_roots(root);
  }
  return root.sign_before == 0 ? q.sign_at(root.lower)
                               : sum_of_signs(p_, q, root.lower, root.upper);
}

}  // namespace kairos::ccd
