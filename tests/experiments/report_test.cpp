// The report: one page that needs nothing from outside its folder.

#include "experiments/report/report.hpp"

#include "core/error.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/sweeps/experiment.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <string>

using namespace kairos::experiments;
using kairos::tests::read_all;
using kairos::tests::TemporaryFolder;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the report shows question, command, seed, numbers and versions of an experiment",
          "[report]") {
  const TemporaryFolder folder;
  const std::string spec = folder.file("mine.toml", R"(
title = "Mine & <yours>"
asks = "Does it \"work\"?"
scene = "bullet"
seed = 77
metrics = ["tunnelled", "impacts"]
)");
  (void)run_experiment(read_experiment(spec, Size::quick),
                       {Size::quick, 1, "kairos sweep mine.toml --quick"},
                       folder.path("report/mine"));
  const std::string page = read_all(write_report(folder.path("report")));
  CHECK(has(page, "Mine &amp; &lt;yours&gt;"));
  CHECK(has(page, "Does it &quot;work&quot;?"));
  CHECK(has(page, "kairos sweep mine.toml --quick"));
  CHECK(has(page, "seed 77"));
  CHECK(has(page, "kairos 0."));
  CHECK(has(page, "eigen 3."));
  CHECK(has(page, "href=\"mine/mine_runs.csv\""));
  CHECK(has(page, "prefers-color-scheme: dark"));
  CHECK(has(page, "width=device-width"));
  // Nothing is fetched: no address, no script.
  CHECK_FALSE(has(page, "http:"));
  CHECK_FALSE(has(page, "https:"));
  CHECK_FALSE(has(page, "<script"));
  CHECK_FALSE(has(page, "nan"));
}

TEST_CASE("a folder without experiments has no report", "[report]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_report(folder.path("")), kairos::InputError);
}

TEST_CASE("text cannot become markup", "[report]") {
  CHECK(html("<b>\"&\"</b>") == "&lt;b&gt;&quot;&amp;&quot;&lt;/b&gt;");
}
