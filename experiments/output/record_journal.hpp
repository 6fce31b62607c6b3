#pragma once

#include "experiments/output/file_part.hpp"

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// The records of a journal, read one by one: a file of many gigabytes takes no memory. A record is
/// whole (length and checksum) or not there.
class RecordFile {
 public:
  /// Throws `InputError` where it cannot be opened.
  explicit RecordFile(const std::string& path) : path_(path), file_(path) {}

  /// What the records depend on: the first record. Empty where the file is no journal.
  [[nodiscard]] std::string key() const;
  /// Tells every whole record after the key, in the order in which they were added, with the place
  /// where it begins. Returns where the last one ends.
  std::size_t scan(
      const std::function<void(std::size_t place, std::string_view record)>& take) const;
  /// The record at a place. Throws `InputError` where there is none.
  [[nodiscard]] std::string at(std::size_t place) const;

 private:
  /// The record at a place, and where it ends; false where none is whole.
  bool read(std::size_t place, std::string& record, std::size_t& end) const;

  std::string path_;
  OpenFile file_;
};

/// What is finished of long work, in a file that grows by one record at a time, so that work that
/// was killed goes on where it stopped. What a death cut short is done again. Adding is
/// thread-safe.
class RecordJournal {
 public:
  /// `key`: what the records depend on; a journal of another key is of other work and is begun
  /// anew. `take` is told every record of an earlier run, and its place. Throws `InputError` where
  /// the file cannot be made.
  RecordJournal(std::string path, const std::string& key,
                const std::function<void(std::size_t place, std::string_view record)>& take = {});
  RecordJournal(const RecordJournal&) = delete;
  RecordJournal& operator=(const RecordJournal&) = delete;
  ~RecordJournal();

  /// Returns the place of the record. Throws `RunError` where the disk does not take it.
  std::size_t add(std::string_view record);

 private:
  void load(const std::string& key,
            const std::function<void(std::size_t place, std::string_view record)>& take);
  std::size_t append(const std::string& bytes);

  std::string path_;
  int descriptor_ = -1;
  std::size_t end_ = 0;  ///< of the file; 0: there was none that is ours
  std::mutex mutex_;
};

/// Of the program that runs: another build may give other results.
[[nodiscard]] std::string program_identity();
/// The same on every machine that has a copy of the program: a fingerprint of its file.
[[nodiscard]] std::string program_fingerprint();

}  // namespace kairos::experiments
