// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/child_process.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "parkade/cli/interruption.hpp"
#include "parkade/io/file.hpp"

namespace parkade::cli {
namespace {

std::string lastMessage(const std::string& log) {
  const Result<std::string> text = readFile(log);
  if (!text) return "";
  const std::string mark = "parkade: ";
  const std::size_t at = text->rfind("\n" + mark);
  const std::size_t begin = at != std::string::npos ? at + 1 : text->find(mark);
  if (begin == std::string::npos) return "";
  return text->substr(begin + mark.size(), text->find('\n', begin) - begin - mark.size());
}

volatile std::sig_atomic_t running_child = 0;

// Ends the child too, which writes what it has, and then this program as if nobody had listened.
void passOn(int signal) {
  kill(static_cast<pid_t>(running_child), signal);
  std::raise(signal);
}

}  // namespace

std::string programPath() {
  std::error_code code;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", code);
  return code ? "/proc/self/exe" : path.string();
}

Status runProgram(const std::vector<std::string>& arguments, const std::string& log) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), programPath());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error =
      posix_spawn(&child, words.front().c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return Error{fmt::format("{}: cannot be started: {}", words.front(), std::strerror(error))};
  }
  running_child = child;
  const HandledSignals passed_on(passOn);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return Error{fmt::format("cannot wait for {}: {}", words.front(), std::strerror(errno))};
    }
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFSIGNALED(status)) {
    return Error{
        fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))};
  }
  const std::string message = lastMessage(log);
  return Error{message.empty() ? fmt::format("ended with code {}; see {}", WEXITSTATUS(status), log)
                               : message};
}

}  // namespace parkade::cli
