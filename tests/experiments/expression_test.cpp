// Expressions of sweep specs: what they compute, and what they say when they are wrong.

#include "experiments/sweeps/expression.hpp"

#include "tests/catch.hpp"

#include <stdexcept>
#include <string>

using namespace kairos::experiments;

TEST_CASE("expressions follow the usual precedence", "[expression]") {
  const Values values{{"speed", 20.0}, {"h", 1.0 / 60.0}, {"w", 0.02}};
  CHECK(evaluate("1 + 2*3^2 - 4/2", values) == 17.0);
  CHECK(evaluate("-2^2", values) == -4.0);
  CHECK(evaluate("2^-1", values) == 0.5);
  CHECK(evaluate("(1+2)*(3-5)", values) == -6.0);
  CHECK(evaluate("8/4/2", values) == 1.0);
  CHECK(evaluate("max(0, 1 - (w + 2*0.02)/(speed*h))", values) == Approx(0.82));
  CHECK(evaluate("min(3, 1, 2) + abs(-1) + sqrt(4) + floor(1.5) + ceil(1.5)", values) == 7.0);
  CHECK(evaluate("sin(pi/6) - cos(pi/3)", values) == Approx(0.0).margin(1e-15));
  CHECK(evaluate(" 1e-3 * 1e3 ", values) == 1.0);
}

TEST_CASE("wrong expressions say where and what", "[expression]") {
  const Values values{{"speed", 20.0}};
  for (const char* wrong : {"", "1 +", "(1", "1)", "speeed", "sqrt(1, 2)", "f(1)", "1 2", "*1",
                            "1e999", "max()", "é", "1..2"}) {
    INFO(wrong);
    CHECK_THROWS_AS(evaluate(wrong, values), std::invalid_argument);
  }
  CHECK_THROWS_AS(evaluate(std::string(100000, '('), values), std::invalid_argument);
  CHECK_THROWS_AS(evaluate(std::string(100000, '-') + "1", values), std::invalid_argument);
}

TEST_CASE("names in expressions are whole words", "[expression]") {
  CHECK(uses_name("a + speed*2", "speed"));
  CHECK_FALSE(uses_name("a + speed_2", "speed"));
  CHECK_FALSE(uses_name("topspeed", "speed"));
}
