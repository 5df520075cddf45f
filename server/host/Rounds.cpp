#include "Rounds.h"

#include <linux/close_range.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace naiad {

namespace {

constexpr const char* kPortVariable = "NAIAD_ROUND_PORT";

std::string workingDirectory() {
  std::error_code error;
  return std::filesystem::current_path(error).string();
}

// For ever: it is read while the process exits.
const std::string& g_began_in = *new std::string(workingDirectory());
constinit std::optional<std::uint16_t> g_port_at_exit;

void atExit(int status, void* /*nothing*/) {
  if (status == 0 && g_port_at_exit) startNextRound(*g_port_at_exit);
}

}  // namespace

std::optional<std::uint16_t> portOfLastRound() {
  const char* p_said = std::getenv(kPortVariable);
  if (p_said == nullptr) return std::nullopt;
  const std::string_view text(p_said);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool good = error == std::errc() && end == text.data() + text.size() && port != 0;
  return good ? std::optional(port) : std::nullopt;
}

void startNextRound(std::uint16_t port) {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string words{std::istreambuf_iterator<char>(file), {}};
  std::vector<char*> argv;
  for (std::size_t begin = 0; begin < words.size(); begin = words.find('\0', begin) + 1) {
    argv.push_back(words.data() + begin);
  }
  argv.push_back(nullptr);
  std::cout.flush();
  std::clog.flush();
  std::fflush(nullptr);
  setenv(kPortVariable, std::to_string(port).c_str(), 1);
  // Sockets that are still open would keep the port taken, and logs would lie open twice.
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (chdir(g_began_in.c_str()) == 0) execv("/proc/self/exe", argv.data());
  std::perror("the next round");
}

void startNextRoundAtExit(std::optional<std::uint16_t> port) {
  static const bool registered = on_exit(atExit, nullptr) == 0;
  g_port_at_exit = registered ? port : std::nullopt;
}

}  // namespace naiad
