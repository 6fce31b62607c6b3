// The report: one page that needs nothing from outside its folder.

#include "experiments/report/report.hpp"

#include "core/error.hpp"
#include "experiments/programs/run_experiment.hpp"
#include "experiments/report/bibliography.hpp"
#include "experiments/report/markdown.hpp"
#include "experiments/report/paper.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/report/report_site.hpp"
#include "experiments/run_error.hpp"
#include "simulation/registry.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/locations.hpp"

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

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
  const std::string first = read_all(write_report(folder.path("report")).path);
  CHECK(has(first, "href=\"mine.html\""));
  const std::string page = read_all(folder.path("report/mine.html"));
  CHECK(has(page, "<details><summary>To repeat it"));
  CHECK(has(page, "data-label=\"tunnelled\""));
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

TEST_CASE("the Markdown of the paper: headings, lists, marks, and nothing passes as markup",
          "[report]") {
  std::vector<std::string> asked;
  const Substitution substitution = [&asked](std::string_view kind, std::string_view what) {
    asked.push_back(std::string(kind) + ":" + std::string(what));
    return std::string("<i>42</i>");
  };
  const MarkdownPage page = markdown_html(
      "# Title\n\n## A <part>\n\nOne *two* **three**\n`4 < 5` {{value:a.b}} [in](#place) [no] "
      "(#x)\nsee [@X; @Y].\n\n"
      "- first\n  goes on\n- second\n\n1. one\n\n{{figure:f}}\n\n```\n<code>\n```\nEnd * here.\n",
      "p-", substitution);
  CHECK(page.html ==
        "<h3 id=\"p-a-part-\">A &lt;part&gt;</h3>\n"
        "<p>One <em>two</em> <strong>three</strong> <code>4 &lt; 5</code> <i>42</i> <a "
        "href=\"#place\">in</a> [no] (#x) see "
        "[<i>42</i>, <i>42</i>].</p>\n"
        "<ul>\n<li>first goes on</li>\n<li>second</li>\n</ul>\n<ol>\n<li>one</li>\n</ol>\n"
        "<i>42</i><pre><code>&lt;code&gt;\n</code></pre>\n<p>End * here.</p>\n");
  CHECK(asked == std::vector<std::string>{"value:a.b", "cite:X", "cite:Y", "figure:f"});
  REQUIRE(page.headings.size() == 2);
  CHECK(page.headings[0].text == "Title");
}

TEST_CASE("the bibliography is read whole, and what is wrong in it is named by line", "[report]") {
  const auto entries = read_bibliography(
      "@article{A1,\n author = {M{\\o}ller, T. and B, C.},\n title = {The {RAPID} Way},\n"
      " journal = {J}, volume = {2},\n pages = {1--3}, year = 1997, doi = {10.1/x}\n}\n"
      "@misc{B2,\n title = {Page}\n}\n",
      "x.bib");
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].key == "A1");
  CHECK(entries[1].line == 7);
  CHECK(reference_html(entries[0]) ==
        "Møller, T.; B, C. (1997). The RAPID Way. <em>J</em> 2, 1–3. "
        "<span class=\"doi\">doi:10.1/x</span>");
  try {
    (void)read_bibliography("@misc{C,\n title = {open\n", "x.bib");
    CHECK(false);
  } catch (const kairos::InputError& error) {
    CHECK(std::string(error.what()).starts_with("x.bib:"));
  }
}

namespace {

/// All that may cite: sources, specs, scenes and texts of the tree, the bibliography apart.
std::string citing_text() {
  std::string tree = read_all(kairos::tests::source_path("paper/replication.md"));
  namespace fs = std::filesystem;
  for (const auto& file : fs::recursive_directory_iterator(kairos::tests::source_path(""))) {
    const std::string path = fs::relative(file.path(), kairos::tests::source_path("")).string();
    const std::string kind = file.path().extension().string();
    if (path.starts_with("build") || path.starts_with("out") || path.starts_with(".") ||
        path.ends_with("report_test.cpp")) {
      continue;
    }
    if (kind == ".hpp" || kind == ".cpp" || kind == ".toml" || kind == ".md" || kind == ".py") {
      tree += read_all(file.path().string());
    }
  }
  return tree;
}

/// Keys as they are cited: [Key, eq. 1], [A2000; B2001], [@Key].
std::set<std::string> cited_keys(const std::string& text) {
  static const std::regex key("[\\[ ]@?([A-Z][A-Za-z]+(?:1[89]|20)[0-9]{2}[a-z]?)(?=[\\],;])");
  std::set<std::string> keys;
  for (std::sregex_iterator at(text.begin(), text.end(), key), end; at != end; ++at) {
    keys.insert((*at)[1]);
  }
  return keys;
}

std::vector<BibliographyEntry> bibliography() {
  const std::string path = kairos::tests::source_path("paper/references.bib");
  return read_bibliography(read_all(path), path);
}

}  // namespace

TEST_CASE("every entry of the bibliography is cited somewhere in the tree", "[report]") {
  const std::string tree = citing_text();
  for (const BibliographyEntry& entry : bibliography()) {
    CAPTURE(entry.key);
    CHECK(tree.find(entry.key) != std::string::npos);
  }
}

TEST_CASE("every key that is cited somewhere in the tree is in the bibliography", "[report]") {
  std::set<std::string> known;
  for (const BibliographyEntry& entry : bibliography()) {
    known.insert(entry.key);
  }
  // The pattern finds what it is meant to find.
  CHECK(cited_keys("[Key1999, eq. 2], [@Other2001; @More1970a], not 1999 or [Key]") ==
        std::set<std::string>{"Key1999", "Other2001", "More1970a"});
  std::set<std::string> cited = cited_keys(citing_text());
  CHECK(cited.size() > 30);
  for (const auto& scheme : kairos::schemes()) {
    cited.insert(std::string(scheme->info().source));
  }
  for (const kairos::IntegratorEntry& integrator : kairos::integrator_entries()) {
    cited.insert(std::string(integrator.info.source));
  }
  for (const std::string& key : cited) {
    CAPTURE(key);
    CHECK((key.empty() || known.contains(key)));
  }
}

TEST_CASE("an institution is one author, an address is shown as text", "[report]") {
  const auto entries = read_bibliography(
      "@misc{N,\n author = {{Society of This and That} and Doe, J.},\n title = {T},\n"
      " year = {1999},\n url = {http://example.org/a~b}\n}\n"
      "@mastersthesis{M,\n author = {Doe, J.},\n title = {T},\n type = {Honours},\n"
      " school = {S},\n year = {1999}\n}\n",
      "x.bib");
  const std::string reference = reference_html(entries[0]);
  CHECK(has(reference, "Society of This and That; Doe, J. (1999)."));
  CHECK(has(reference, "<span class=\"doi\">example.org/a~b</span>"));
  CHECK(has(reference_html(entries[1]), " Honours."));
}

TEST_CASE("the paper cites what is in the bibliography, each entry of it once", "[report]") {
  const std::string folder = kairos::tests::source_path("paper/");
  const std::string text = read_all(folder + "references.bib");
  const auto entries = read_bibliography(text, "references.bib");
  std::set<std::string> keys;
  for (const BibliographyEntry& entry : entries) {
    CAPTURE(entry.key);
    CHECK(keys.insert(entry.key).second);
    CHECK(entry.fields.contains("title"));
  }
  const Paper paper = fill_paper({});  // nothing was made: every number is a hole
  for (const std::string& hole : paper.holes) {
    CAPTURE(hole);
    CHECK_FALSE(hole.starts_with("cite:"));
  }
  CHECK(paper.holes.size() > 20);
  // The thesis' nineteen references, each by itself.
  for (const char* key :
       {"Webopedia1999", "Larsen1999", "Gottschalk1996", "Gottschalk1997a", "Gottschalk1997b",
        "Gottschalk1997c", "Gottschalk1997d", "Gottschalk1997e", "Cohen1995", "Hudson1997",
        "Bergen1999", "Bergen1997", "Keller1993", "Cremer1997", "Lubich1992", "NASA1992",
        "Rorke1998", "Norman1990", "Bowman1995"}) {
    CAPTURE(key);
    CHECK(keys.contains(key));
    CHECK(has(paper.references, std::string("ref-") + key));
  }
}

TEST_CASE("no page of the report is written over by another", "[report]") {
  const TemporaryFolder folder;
  const SitePage one{"references.html", "An experiment", "", "", "<p>one</p>"};
  const SitePage other{"references.html", "References", "", "", "<p>other</p>"};
  const std::string site = folder.path("site");
  std::filesystem::create_directory(site);
  CHECK_NOTHROW(write_site(site, {one}, {}));
  CHECK_THROWS_AS(write_site(site, {one, other}, {}), RunError);
}
