#include "host/process/ReexecCommand.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

namespace naiad {

namespace {

constexpr const char* kPort = "--port";

/// Replaces the port on the command line, if any. For a port in a config file, run() sets NAIAD_PORT, which
/// overrides it.
std::vector<std::string> withPort(std::vector<std::string> arguments, const std::string& port) {
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    if (arguments[i] == kPort && i + 1 < arguments.size()) arguments[i + 1] = port;
    if (arguments[i].starts_with(std::string(kPort) + "=")) arguments[i] = std::string(kPort) + "=" + port;
  }
  return arguments;
}

std::vector<const char*> argvPointers(const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  pointers.push_back(nullptr);
  return pointers;
}

/// Returns the path of this process's program. If an upgrade has put a new file there, that one will be run.
std::string programPath() {
  constexpr std::string_view kReplaced = " (deleted)";  // added by the kernel
  std::error_code error;
  std::string path = std::filesystem::read_symlink("/proc/self/exe", error).string();
  if (path.ends_with(kReplaced) && !std::filesystem::exists(path, error))
    path.resize(path.size() - kReplaced.size());
  return path;
}

}  // namespace

ReexecCommand::ReexecCommand(std::vector<std::string> arguments)
    : m_program(programPath()), m_arguments(std::move(arguments)) {}

ReexecCommand::ReexecCommand(int argc, const char* const* argv)
    : ReexecCommand(std::vector<std::string>(argv, argv + argc)) {}

ReexecCommand ReexecCommand::ofProcess() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return ReexecCommand(std::move(arguments));
}

std::vector<std::string> ReexecCommand::arguments() const {
  return m_arguments.empty() ? m_arguments : std::vector(m_arguments.begin() + 1, m_arguments.end());
}

std::vector<const char*> ReexecCommand::argv() const {
  return argvPointers(m_arguments);
}

void ReexecCommand::run(std::uint16_t port) const {
  const std::string number = std::to_string(port);
  setenv("NAIAD_PORT", number.c_str(), 1);
  const std::vector<std::string> arguments = withPort(m_arguments, number);
  execv(m_program.c_str(),
        const_cast<char* const*>(argvPointers(arguments).data()));  // execv() does not change the arguments
  throw std::system_error(errno, std::generic_category(), "cannot restart the server");
}

}  // namespace naiad
