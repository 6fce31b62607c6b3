#include "experiments/toi/toi_stream.hpp"

#include "core/error.hpp"
#include "experiments/output/csv_row.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/run_error.hpp"
#include "experiments/toi/toi_query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <exception>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace kairos::experiments {
namespace {

/// Takes the first line off a text, without its line break.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

bool blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

/// Lines of the input and what becomes of them; ticket: their place in the order of the file.
struct Job {
  std::size_t ticket = 0;
  std::int64_t first_line = 0;
  std::string lines;
  std::string answers;
  std::string complaints;
  std::int64_t bad_rows = 0;
  std::exception_ptr error;  ///< ends the work, after the answers
};

/// Answers the rows of one job.
class Answerer {
 public:
  Answerer(const ToiQueryFormat& format, const ToiStreamOptions& options, const std::string& file)
      : format_(format), options_(options), file_(file) {}

  void answer(Job& job) {
    std::string_view text = job.lines;
    for (std::int64_t line = job.first_line; !text.empty(); ++line) {
      const std::string_view row = take_line(text);
      if (blank(row)) {
        continue;
      }
      try {
        job.answers += answer(row);
      } catch (const BadField& bad) {
        const InputError error(file_, static_cast<int>(line), std::string(bad.column), bad.reason);
        if (!options_.keep_going) {
          throw error;
        }
        job.complaints += fmt::format("{}\n", error.what());
        job.answers += invalid(row);
        ++job.bad_rows;
      }
    }
  }

 private:
  std::string_view answer(std::string_view row) {
    const ToiQuery query = format_.read(row, scratch_);
    const TimeOfImpact toi = options_.detector->time_of_impact(
        {query.shape_a, query.motion_a}, {query.shape_b, query.motion_b},
        {Instant{}, query.duration}, options_.tolerance);
    if (!std::isfinite(toi.t_lo + toi.t_hi + toi.gap + toi.normal.sum())) {
      throw BadField{"", "the answer is beyond the range of a double"};
    }
    row_.field(query.id).text(to_string(toi.status)).number(toi.t_lo).number(toi.t_hi);
    return row_.number(toi.gap).vector(toi.normal).count(toi.evaluations).finish();
  }
  /// A bad row keeps its place among the answers.
  std::string_view invalid(std::string_view row) {
    row_.field(format_.id(row, scratch_)).text("invalid");
    for (int i = 0; i < 7; ++i) {
      row_.field("");
    }
    return row_.finish();
  }

  const ToiQueryFormat& format_;
  const ToiStreamOptions& options_;
  const std::string& file_;
  ToiQueryFormat::Scratch scratch_;
  CsvRow row_;
};

/// The line of workers: each takes the next lines, answers them, and waits for its turn to write.
class Stream {
 public:
  Stream(LineBlocks& queries, const ToiStreamOptions& options)
      : queries_(queries), options_(options), format_(read_header()) {}

  std::int64_t run() {
    emit("id,status,t_lo,t_hi,gap,nx,ny,nz,evaluations\n");
    const std::size_t count = options_.threads == 0 ? default_threads() : options_.threads;
    std::vector<std::thread> workers;
    for (std::size_t i = 1; i < count; ++i) {
      workers.emplace_back([this] { work(); });
    }
    work();
    for (std::thread& worker : workers) {
      worker.join();
    }
    if (error_) {
      std::rethrow_exception(error_);
    }
    return bad_rows_;
  }

 private:
  ToiQueryFormat read_header() {
    std::string header;
    while (blank(header)) {
      if (first_lines_.empty() && !queries_.next(first_lines_, first_line_)) {
        throw InputError(queries_.name(), 0, "",
                         "is empty; needed: a header and one row per query");
      }
      std::string_view text = first_lines_;
      header = take_line(text);
      first_lines_.erase(0, first_lines_.size() - text.size());
      ++first_line_;
    }
    return {header, first_line_ - 1, queries_.name()};
  }

  void work() {
    Answerer answerer(format_, options_, queries_.name());
    Job job;
    while (take(job)) {
      if (!job.error) {
        try {
          answerer.answer(job);
        } catch (...) {
          job.error = std::current_exception();
        }
      }
      if (!deliver(job)) {
        return;
      }
    }
  }

  bool take(Job& job) {
    const std::lock_guard lock(input_);
    job.answers.clear();
    job.complaints.clear();
    job.bad_rows = 0;
    if (stopped_ || !take_lines(job)) {
      return false;
    }
    job.ticket = next_ticket_++;
    return true;
  }

  bool take_lines(Job& job) {
    if (!first_lines_.empty()) {
      job.lines = std::move(first_lines_);
      job.first_line = first_line_;
      first_lines_.clear();
      return true;
    }
    try {
      return queries_.next(job.lines, job.first_line);
    } catch (...) {
      job.error = std::current_exception();
      return true;
    }
  }

  /// Writes the answers when it is this job's turn; false when the work is over.
  bool deliver(const Job& job) {
    std::unique_lock lock(output_);
    turn_.wait(lock, [&] { return stopped_ || next_to_write_ == job.ticket; });
    if (stopped_) {
      return false;
    }
    error_ = job.error;
    bad_rows_ += job.bad_rows;
    try {
      emit(job.answers);
    } catch (...) {
      error_ = std::current_exception();
    }
    std::fputs(job.complaints.c_str(), stderr);
    stopped_ = error_ != nullptr;
    ++next_to_write_;
    turn_.notify_all();
    return !stopped_;
  }

  static void emit(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
      throw RunError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
    }
  }

  LineBlocks& queries_;
  const ToiStreamOptions& options_;
  std::string first_lines_;  ///< what came with the header
  std::int64_t first_line_ = 1;
  const ToiQueryFormat format_;

  std::mutex input_;
  std::size_t next_ticket_ = 0;
  std::mutex output_;
  std::condition_variable turn_;
  std::size_t next_to_write_ = 0;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr error_;
  std::int64_t bad_rows_ = 0;
};

}  // namespace

std::int64_t answer_toi_queries(LineBlocks& queries, const ToiStreamOptions& options) {
  return Stream(queries, options).run();
}

}  // namespace kairos::experiments
