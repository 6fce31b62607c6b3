#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// What is finished of long work, in a file that grows by one record at a time, so that work that
/// was killed goes on where it stopped. A record is whole (length and checksum) or not there; what
/// a death cut short is done again. Adding is thread-safe.
class RecordJournal {
 public:
  /// `key`: what the records depend on; a journal of another key is of other work and is begun
  /// anew. Throws `InputError` where the file cannot be made.
  RecordJournal(std::string path, const std::string& key);
  RecordJournal(const RecordJournal&) = delete;
  RecordJournal& operator=(const RecordJournal&) = delete;
  ~RecordJournal();

  /// Records of an earlier run, in the order in which they were added.
  [[nodiscard]] const std::vector<std::string>& found() const { return found_; }
  /// Throws `RunError` where the disk does not take it.
  void add(std::string_view record);

 private:
  void load(const std::string& key);
  void append(const std::string& bytes);

  std::string path_;
  int descriptor_ = -1;
  std::mutex mutex_;
  std::vector<std::string> found_;
};

/// Of the program that runs: another build may give other results.
[[nodiscard]] std::string program_identity();

}  // namespace kairos::experiments
