#include "host/program/Announcement.h"

#include <algorithm>
#include <asio/ip/address.hpp>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "host/loop/HostEndpoint.h"
#include "host/program/QrCode.h"
#include "host/settings/HostOptions.h"
#include "host/settings/SshDoor.h"
#include "shared/admin/ControlClient.h"
#include "shared/admin/ControlPath.h"
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

void addOtherDoors(const HostOptions& options, std::vector<std::string>& lines) {
  if (const auto door = SshDoor::parse(options.ssh_door))
    lines.push_back("With ssh only: " + door->command());
  if (!options.web_address.empty()) lines.push_back("In a browser: " + options.web_address);
}

bool isHomeAlone(const std::string& address) {
  std::error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

}  // namespace

std::vector<std::string> joinInstructions(const HostEndpoint& endpoint, const HostOptions& options,
                                          const AccessHints& openness) {
  const auto local = endpoint.joinLink(false);
  std::vector<std::string> lines{"Join from this machine with: dfclient " +
                                 (local ? local->text() : endpoint.joinArguments())};
  if (isHomeAlone(options.address)) {
    lines.push_back("Only this machine can join: listening on " + endpoint.address() + ". " +
                    openness.how_to_open);
    addOtherDoors(options, lines);
    return lines;
  }
  if (const auto link = endpoint.joinLink(true)) lines.push_back("From elsewhere: dfclient " + link->text());
  if (const auto fingerprint = endpoint.fingerprint()) {
    const std::string begin = options.link_host.empty()
                                  ? "From elsewhere, use this machine's name or address in the link. Its"
                                  : "Its";
    lines.push_back(begin + " key is " + fingerprint->text());
  }
  addOtherDoors(options, lines);
  const bool any = options.address == "::" || options.address == "0.0.0.0";
  lines.push_back(
      "Listening on " +
      (any ? "every address of this machine, port " + std::to_string(endpoint.port()) : endpoint.address()) +
      ", TCP and UDP. " + openness.how_to_restrict);
  return lines;
}

std::string listenErrorText(const ListenError& error, const HostOptions& options) {
  const auto control = options.control.empty() ? controlPath(static_cast<std::uint16_t>(options.port))
                                               : std::filesystem::path(options.control);
  if (error.code() != std::errc::address_in_use || !control) return error.what();
  try {
    const AdminAnswer answer = ControlClient(*control).sendRequest(readAdminRequest({"link"}));
    if (!answer.ok) return error.what();
    return std::string(error.what()) + " A server is already running there; join it with: " + answer.text;
  } catch (const ServerUnreachable&) {
    return error.what();
  }
}

std::vector<std::string> qrLines(const HostOptions& options) {
  if (!options.qr) return {};
  std::vector<std::string> code = qrCode(options.web_address);
  if (!code.empty()) return code;
  return {"No QR code: this program was built without libqrencode."};
}

void writeEndpointFiles(const HostOptions& options, const HostEndpoint& endpoint) {
  writeLine(options.port_file, "port", std::to_string(endpoint.port()));
  writeLine(options.join_file, "join", endpoint.joinArguments());
}

}  // namespace naiad
