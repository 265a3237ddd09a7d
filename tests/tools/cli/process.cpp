// Runs the program as a process of its own.
#include "process.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace broadside::cli {
namespace {

std::filesystem::path new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "broadside_cli_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder can be made");
  return name;
}

[[noreturn]] void become_program(std::vector<std::string> arguments, const std::string& program,
                                 const std::filesystem::path& folder) {
  const auto redirect = [](int stream, const std::filesystem::path& file) {
    dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), stream);
  };
  redirect(STDOUT_FILENO, folder / "output");
  redirect(STDERR_FILENO, folder / "errors");
  arguments.insert(arguments.begin(), program);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(program.c_str(), pointers.data());
  _exit(127);
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const std::string& program)
    : folder_(new_folder()), id_(fork()) {
  if (id_ < 0) throw std::runtime_error("no process can be made");
  if (id_ == 0) become_program(arguments, program, folder_);
}

Process::~Process() {
  if (running_) {
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Process::signal(int number) const { kill(id_, number); }

bool Process::has_open_file_in(const TemporaryFolder& folder) const {
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(id_) + "/fd", ignored)) {
    const std::filesystem::path to = std::filesystem::read_symlink(entry.path(), ignored);
    const std::string name = to.filename();
    if (to.parent_path() == folder.path() && (name.starts_with('#') || name.ends_with(".part"))) return true;
  }
  return false;
}

std::string Process::output() const { return text_of(folder_ / "output"); }

Ended Process::wait() {
  int status = 0;
  waitpid(id_, &status, 0);
  running_ = false;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), output(),
          text_of(folder_ / "errors")};
}

Ended run(const std::vector<std::string>& arguments) { return Process(arguments).wait(); }

Ended shell(const std::string& line) {
  setenv("BROADSIDE", BROADSIDE_PROGRAM, 1);
  return Process({"-c", line}, "/bin/sh").wait();
}

TemporaryFolder::TemporaryFolder() : path_(new_folder()) {}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryFolder::put(const std::string& name, const std::string& text) const {
  std::ofstream(file(name), std::ios::binary) << text;
  return file(name);
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace broadside::cli
