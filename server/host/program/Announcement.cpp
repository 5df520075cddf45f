#include "host/program/Announcement.h"

#include <asio/ip/address.hpp>
#include <stdexcept>
#include <system_error>

#include "host/program/Host.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

void writeLine(const std::string& path, const char* what, const std::string& line) {
  if (path.empty()) return;
  try {
    publishFile(path, line + "\n");
  } catch (const std::system_error& error) {
    throw std::runtime_error("The " + std::string(what) + " file " + path +
                             " cannot be written: " + error.what());
  }
}

bool isHomeAlone(const std::string& address) {
  std::error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

}  // namespace

std::vector<std::string> howToJoin(const Host& host, const HostOptions& options, const Openness& openness) {
  std::vector<std::string> lines{"Join from this machine with: dfclient " + host.joinArguments()};
  if (isHomeAlone(options.address)) {
    lines.push_back("From elsewhere nobody can join: it listens on " + host.address() + " alone. " +
                    openness.how_to_open);
    return lines;
  }
  if (const auto fingerprint = host.fingerprint()) {
    lines.push_back("From elsewhere with its name or address; its key is " + fingerprint->text());
  }
  const bool any = options.address == "::" || options.address == "0.0.0.0";
  lines.push_back(
      "Listening on " +
      (any ? "every address of this machine, port " + std::to_string(host.port()) : host.address()) +
      ", TCP and UDP. " + openness.how_to_restrict);
  return lines;
}

void writeWhereabouts(const HostOptions& options, const Host& host) {
  writeLine(options.port_file, "port", std::to_string(host.port()));
  writeLine(options.join_file, "join", host.joinArguments());
}

}  // namespace naiad
