// Runs the program as a process of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/text_of.hpp"

namespace broadside::cli {

/// What a process came to.
struct Ended {
  int status;  ///< the exit status; 128 + the signal where one ended it
  std::string output;
  std::string errors;
};

class TemporaryFolder;

/// The program with these arguments, running, its output and errors going to files.
class Process {
 public:
  explicit Process(const std::vector<std::string>& arguments, const std::string& program = BROADSIDE_PROGRAM);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;

  /// Whether it has a file open that lies in this folder, under a name or under none yet.
  bool has_open_file_in(const TemporaryFolder& folder) const;

  /// What it has written to its output up to now.
  std::string output() const;

  Ended wait();

 private:
  std::filesystem::path folder_;  // for the two files; removed at the end
  pid_t id_;
  bool running_ = true;
};

/// Runs the program to its end.
Ended run(const std::vector<std::string>& arguments);

/// Runs a line of a shell to its end; $BROADSIDE in it is the program.
Ended shell(const std::string& line);

/// A folder that is there as long as this object is.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::string file(const std::string& name) const { return (path_ / name).string(); }

  /// A new file in it, by its path.
  std::string put(const std::string& name, const std::string& text) const;

  /// The names of what is in it.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

}  // namespace broadside::cli
