#include "host/program/Announcement.h"

#include <fstream>
#include <stdexcept>

#include "host/program/Host.h"

namespace naiad {

namespace {

void writeLine(const std::string& path, const char* what, const std::string& line) {
  if (path.empty()) return;
  std::ofstream file(path);
  if (!(file << line << std::endl)) {
    throw std::runtime_error("The " + std::string(what) + " file " + path + " cannot be written.");
  }
}

}  // namespace

std::vector<std::string> howToJoin(const Host& host) {
  std::vector<std::string> lines{"Join from this machine with: dfclient " + host.joinArguments()};
  if (const auto fingerprint = host.fingerprint()) {
    lines.push_back("From elsewhere with its name or address; its key is " + fingerprint->text());
  }
  return lines;
}

void writeWhereabouts(const HostOptions& options, const Host& host) {
  writeLine(options.port_file, "port", std::to_string(host.port()));
  writeLine(options.join_file, "join", host.joinArguments());
}

}  // namespace naiad
