// An independent judge of `certified`: hard queries of many classes, and the truth of each answer
// by interval proof in extended and quadruple precision. See README.md.
#include "ccd/certified.hpp"
#include "tests/judge/families.hpp"
#include "tests/judge/parting.hpp"
#include "tests/judge/query_file.hpp"
#include "tests/judge/self_check.hpp"
#include "tests/judge/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <vector>

namespace kairos::judge {
namespace {

struct Arguments {
  std::uint64_t queries = 10000;
  std::uint64_t seed = 1;
  std::string family;      ///< empty: all
  std::string in;          ///< a file of queries instead of the generator
  std::string out;         ///< where queries with faults go
  std::size_t keep = 100;  ///< per class, into `out`
  bool told = false;       ///< also those that are told, not faults
  bool self_check = false;
  std::optional<std::uint64_t> index;
};

constexpr std::string_view usage =
    "judge_ccd [--queries N] [--seed S] [--class NAME] [--index I] [--in QUERIES.csv]\n"
    "          [--out FAULTY.csv] [--keep N] [--told] [--list] [--self-check]\n";

std::vector<Family> all_families() {
  std::vector<Family> all;
  for (const auto& some :
       {touching_families(), plane_families(), graze_families(), scale_families(),
        extreme_families(), polynomial_families(), parting_families(), changed_families()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Asks, judges, counts and keeps what is wrong.
class Session {
 public:
  explicit Session(const Arguments& arguments) : arguments_(arguments) {
    if (!arguments.out.empty()) {
      out_.open(arguments.out);
      out_ << csv_header()
           << ",faults,size,at,rounding,status,t_lo,t_hi,gap,nx,ny,nz,evaluations,milliseconds\n";
    }
  }

  void take(const Query& query, const Family& family, Tally& tally) {
    const double before = processor_time();
    TimeOfImpact answer;
    try {
      answer = family.parting ? ask_parting(query, *certified_) : query.ask(*certified_);
    } catch (const std::invalid_argument&) {
      tally.refuse(!family.extreme);
      return;
    }
    const double seconds = processor_time() - before;
    if (answer.status == ToiStatus::undecided && std::isinf(answer.gap)) {  // beyond its range
      tally.refuse(!family.extreme);
      return;
    }
    const Verdict verdict =
        family.parting ? judge_parting(query, answer) : judge(query, answer, *certified_);
    tally.add(answer, verdict, seconds);
    keep(query, answer, verdict, seconds);
  }
  void next_family() { kept_ = 0; }

 private:
  void keep(const Query& query, const TimeOfImpact& answer, const Verdict& verdict,
            double seconds) {
    const bool noted = verdict.breaks_a_promise() || arguments_.index ||
                       (arguments_.told && !verdict.faults().empty());
    if (!out_.is_open() || !noted || kept_++ >= arguments_.keep) {
      return;
    }
    const Vector3& n = answer.normal;
    out_ << csv_row(query)
         << fmt::format(
                ",{},{:.3g},{:.17g},{:.3g},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{:"
                ".3f}\n",
                verdict.faults(), verdict.depth, verdict.when, verdict.rounding,
                to_string(answer.status), answer.t_lo, answer.t_hi, answer.gap, n.x(), n.y(), n.z(),
                answer.evaluations, 1e3 * seconds);
  }

  const Arguments& arguments_;
  std::unique_ptr<ContactDetector> certified_ = ccd::make_certified();
  std::ofstream out_;
  std::size_t kept_ = 0;
};

void show(const Tally& tally, const std::string& name) {
  std::cout << tally.row(name) << std::endl;
}

/// A query is asked as its class is: also when its bodies are apart.
Tally judge_file(const Arguments& arguments, Session& session) {
  const std::vector<Family> families = all_families();
  Tally tally;
  for (const Query& query : read_queries(arguments.in)) {
    const auto known = std::find_if(families.begin(), families.end(), [&](const Family& family) {
      return family.name == query.family;
    });
    session.take(query, known == families.end() ? Family{"file", "", nullptr} : *known, tally);
  }
  return tally;
}

Tally judge_family(const Arguments& arguments, const Family& family, std::uint64_t stream,
                   std::uint64_t count, Session& session) {
  Tally tally;
  const std::uint64_t first = arguments.index.value_or(0);
  for (std::uint64_t i = first; i < (arguments.index ? first + 1 : count); ++i) {
    Random random(arguments.seed, stream, i << 20U);
    Query query = family.make(random);
    query.id = fmt::format("{}-{}-{}", family.name, arguments.seed, i);
    query.family = family.name;
    session.take(query, family, tally);
  }
  return tally;
}

Arguments parsed(const std::vector<std::string>& words) {
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--told") {
      arguments.told = true;
      continue;
    }
    if (word == "--self-check") {
      arguments.self_check = true;
      continue;
    }
    if (word == "--list") {
      for (const Family& family : all_families()) {
        std::cout << fmt::format("{:18}{}\n", family.name, family.what);
      }
      arguments.queries = 0;
      continue;
    }
    if (i + 1 == words.size()) {
      throw std::runtime_error(word + ": unknown, or its value is missing\n" + std::string(usage));
    }
    const std::string& value = words[++i];
    if (word == "--queries") {
      arguments.queries = std::stoull(value);
    } else if (word == "--seed") {
      arguments.seed = std::stoull(value);
    } else if (word == "--class") {
      arguments.family = value;
    } else if (word == "--index") {
      arguments.index = std::stoull(value);
    } else if (word == "--in") {
      arguments.in = value;
    } else if (word == "--out") {
      arguments.out = value;
    } else if (word == "--keep") {
      arguments.keep = std::stoull(value);
    } else {
      throw std::runtime_error(word + ": unknown\n" + std::string(usage));
    }
  }
  return arguments;
}

/// Returns how many queries broke a promise.
std::size_t run(const Arguments& arguments) {
  if (arguments.self_check) {
    return static_cast<std::size_t>(self_check());
  }
  if (arguments.queries == 0) {
    return 0;
  }
  Session session(arguments);
  std::cout << "seed " << arguments.seed << '\n' << Tally::header() << std::endl;
  if (!arguments.in.empty()) {
    const Tally tally = judge_file(arguments, session);
    show(tally, "file");
    return tally.broken();
  }
  const std::vector<Family> families = all_families();
  Tally total;
  bool known = false;
  for (std::size_t k = 0; k < families.size(); ++k) {
    if (!arguments.family.empty() && families[k].name != arguments.family) {
      continue;
    }
    known = true;
    const std::uint64_t parts = arguments.family.empty() ? families.size() : 1;
    const std::uint64_t count = (arguments.queries + parts - 1) / parts;
    session.next_family();
    const Tally tally = judge_family(arguments, families[k], k, count, session);
    show(tally, std::string(families[k].name));
    total.add(tally);
  }
  if (!known) {
    throw std::runtime_error(arguments.family + ": no such class; --list names them");
  }
  show(total, "all");
  std::cout << total.broken() << " queries with a broken promise\n";
  return total.broken();
}

}  // namespace
}  // namespace kairos::judge

int main(int argc, char** argv) {
  try {
    return kairos::judge::run(kairos::judge::parsed({argv + 1, argv + argc})) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
