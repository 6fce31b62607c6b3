#include "experiments/toi/row_stream.hpp"

#include "core/error.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
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

/// Answers the queries of one job.
class JobAnswerer {
 public:
  JobAnswerer(const RowFormat& format, bool keep_going, const std::string& file)
      : rows_per_query_(format.rows_per_query),
        keep_going_(keep_going),
        file_(file),
        answerer_(format.make_answerer()) {}

  void answer(Job& job) {
    std::string_view text = job.lines;
    rows_.clear();
    lines_.clear();
    for (std::int64_t line = job.first_line; !text.empty(); ++line) {
      const std::string_view row = take_line(text);
      if (blank(row)) {
        continue;
      }
      rows_.push_back(row);
      lines_.push_back(line);
      if (rows_.size() == rows_per_query_) {
        answer_query(job);
      }
    }
    if (!rows_.empty()) {
      throw InputError(
          file_, static_cast<int>(lines_.front()), "",
          fmt::format("begins a query of {} rows that has only {}", rows_per_query_, rows_.size()));
    }
  }

 private:
  void answer_query(Job& job) {
    try {
      job.answers += answerer_->answer(rows_, lines_.front());
    } catch (const BadField& bad) {
      const InputError error(file_, static_cast<int>(lines_[bad.row]), std::string(bad.column),
                             bad.reason);
      if (!keep_going_) {
        throw error;
      }
      job.complaints += fmt::format("{}\n", error.what());
      job.answers += answerer_->invalid(rows_, lines_.front());
      ++job.bad_rows;
    }
    rows_.clear();
    lines_.clear();
  }

  std::size_t rows_per_query_;
  bool keep_going_;
  const std::string& file_;
  std::unique_ptr<RowAnswerer> answerer_;
  std::vector<std::string_view> rows_;  ///< of the query that is being read
  std::vector<std::int64_t> lines_;     ///< where they are
};

/// The line of workers: each takes the next lines, answers them, and waits for its turn to write.
class Stream {
 public:
  using ReadFormat = std::function<RowFormat(std::string_view line, std::int64_t number)>;

  Stream(LineBlocks& queries, const RowStreamOptions& options, const ReadFormat& read_format)
      : queries_(queries), options_(options), format_(read_first_line(read_format)) {}

  std::int64_t run() {
    emit(format_.answer_header);
    const std::size_t count = options_.threads == 0 ? default_threads() : options_.threads;
    {
      const std::vector<std::jthread> others = start_threads(count - 1, [this] { work(); });
      work();
    }
    if (error_) {
      std::rethrow_exception(error_);
    }
    return bad_rows_;
  }

 private:
  RowFormat read_first_line(const ReadFormat& read_format) {
    std::string_view rest;
    std::string_view line;
    do {
      if (rest.empty() && !queries_.next(first_lines_, first_line_)) {
        throw InputError(queries_.name(), 0, "",
                         "is empty; needed: a header and one row per query");
      }
      rest = rest.empty() ? std::string_view(first_lines_) : rest;
      line = take_line(rest);
      ++first_line_;
    } while (blank(line));
    RowFormat format = read_format(line, first_line_ - 1);
    if (format.first_line_is_a_row) {
      --first_line_;
      rest = {line.data(), static_cast<std::size_t>(rest.data() + rest.size() - line.data())};
    }
    first_lines_.erase(0, first_lines_.size() - rest.size());
    return format;
  }

  void work() {
    JobAnswerer answerer(format_, options_.keep_going, queries_.name());
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
    try {
      if (!first_lines_.empty()) {
        job.lines = std::move(first_lines_);
        job.first_line = first_line_;
        first_lines_.clear();
      } else if (!queries_.next(job.lines, job.first_line)) {
        job.lines.clear();
        job.first_line = unfinished_line_;
      }
      keep_queries_whole(job);
    } catch (...) {
      job.error = std::current_exception();
      return true;
    }
    return !job.lines.empty();
  }
  /// Keeps rows of an unfinished query for the next job, and adds those of the job before.
  void keep_queries_whole(Job& job) {
    if (format_.rows_per_query == 1) {
      return;
    }
    const bool is_last = job.lines.empty();
    if (!unfinished_.empty()) {
      job.lines.insert(0, unfinished_);
      job.first_line = unfinished_line_;
      unfinished_.clear();
    }
    if (is_last) {
      return;
    }
    std::string_view text = job.lines;
    std::size_t rows = 0;
    std::size_t whole = 0;  // bytes of whole queries
    std::int64_t line = job.first_line;
    unfinished_line_ = line;
    while (!text.empty()) {
      rows += blank(take_line(text)) ? 0 : 1;
      ++line;
      if (rows == format_.rows_per_query) {
        rows = 0;
        whole = job.lines.size() - text.size();
        unfinished_line_ = line;
      }
    }
    unfinished_.assign(job.lines, whole);
    job.lines.resize(whole);
    if (job.lines.empty()) {
      job.lines = "\n";  // nothing to answer yet; not the end
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
  const RowStreamOptions& options_;
  std::string first_lines_;  ///< what came with the first line
  std::int64_t first_line_ = 1;
  const RowFormat format_;
  std::string unfinished_;  ///< rows of a query whose end is still to come
  std::int64_t unfinished_line_ = 1;

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

std::int64_t answer_rows(
    LineBlocks& queries, const RowStreamOptions& options,
    const std::function<RowFormat(std::string_view line, std::int64_t number)>& read_format) {
  return Stream(queries, options, read_format).run();
}

}  // namespace kairos::experiments
