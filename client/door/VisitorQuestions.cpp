#include "client/door/VisitorQuestions.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxLine = 200;  // bytes
constexpr int kMaxTries = 3;

/// A byte of the terminal; nothing if none comes until `end`.
std::optional<char> readByte(Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(left.count()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    char byte = 0;
    const ssize_t size = ::read(STDIN_FILENO, &byte, 1);
    if (size < 0 && errno == EINTR) continue;
    if (size != 1) return std::nullopt;
    return byte;
  }
}

std::optional<std::size_t> choiceOf(const std::string& answer, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (answer == names[i] || answer == std::to_string(i + 1)) return i;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> askLine(const std::string& question, std::chrono::seconds patience) {
  std::fputs(question.c_str(), stdout);
  std::fflush(stdout);
  const auto end = Clock::now() + patience;
  std::string line;
  while (line.size() <= kMaxLine) {
    const auto byte = readByte(end);
    if (!byte) return std::nullopt;
    if (*byte == '\n') return line;
    line.push_back(*byte);
  }
  return std::nullopt;
}

std::optional<std::size_t> askChoice(const std::vector<std::string>& names, std::chrono::seconds patience) {
  for (std::size_t i = 0; i < names.size(); ++i) std::printf("%3zu  %s\n", i + 1, names[i].c_str());
  for (int i = 0; i < kMaxTries; ++i) {
    const auto answer = askLine("Which game? ", patience);
    if (!answer) return std::nullopt;
    if (const auto choice = choiceOf(*answer, names)) return choice;
    std::printf("Its number is wanted, 1 to %zu.\n", names.size());
  }
  return std::nullopt;
}

std::optional<std::string> askName(const std::string& known, std::chrono::seconds patience) {
  const auto answer = askLine(known.empty() ? "Your name? " : "Your name? [" + known + "] ", patience);
  if (!answer) return std::nullopt;
  const bool is_blank =
      std::all_of(answer->begin(), answer->end(), [](char c) { return c == ' ' || c == '\r'; });
  return is_blank && !known.empty() ? known : safeName(*answer);
}

std::optional<bool> askYes(const std::string& question, std::chrono::seconds patience) {
  const auto answer = askLine(question + " [y] ", patience);
  if (!answer) return std::nullopt;
  return !answer->starts_with('n') && !answer->starts_with('N');
}

}  // namespace naiad
