#include "host/program/Announcement.h"

#include <algorithm>
#include <asio/ip/address.hpp>
#include <stdexcept>
#include <system_error>

#include "host/program/Host.h"
#include "host/program/QrCode.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

constexpr std::uint16_t kSshPort = 22;
constexpr std::size_t kMaxWebAddress = 300;  // a QR code of more does not fit a terminal

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
    lines.push_back("With ssh alone: " + door->command());
  if (!options.web_address.empty()) lines.push_back("In a browser: " + options.web_address);
}

bool isWebAddress(const std::string& text) {
  const bool begins = text.starts_with("https://") || text.starts_with("http://");
  return begins && text.size() <= kMaxWebAddress &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

bool isHomeAlone(const std::string& address) {
  std::error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

}  // namespace

std::string announcementComplaint(const HostOptions& options) {
  if (!options.link_host.empty() && !LinkHost::parse(options.link_host))
    return "--link-host: HOST or HOST:PORT is wanted, IPv6 in brackets";
  if (!options.ssh_door.empty() && !SshDoor::parse(options.ssh_door))
    return "--ssh-door: USER@HOST or USER@HOST:PORT is wanted";
  if (!options.web_address.empty() && !isWebAddress(options.web_address))
    return "--web-address: an address that begins with https:// or http:// is wanted, of 300 characters at "
           "most";
  if (options.qr && options.web_address.empty()) return "--qr shows --web-address, which is not given";
  return {};
}

std::optional<SshDoor> SshDoor::parse(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos || at == 0 || text.front() == '-') return std::nullopt;
  const std::string_view user = text.substr(0, at);
  const bool is_plain = std::all_of(user.begin(), user.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  const auto where = LinkHost::parse(text.substr(at + 1), kSshPort);
  if (!is_plain || !where) return std::nullopt;
  return SshDoor{std::string(user), *where};
}

std::string SshDoor::command() const {
  const std::string port = where.port == kSshPort ? "" : "-p " + std::to_string(where.port) + " ";
  return "ssh " + port + user + "@" + where.host;
}

std::vector<std::string> howToJoin(const Host& host, const HostOptions& options, const Openness& openness) {
  const auto local = host.joinLink(false);
  std::vector<std::string> lines{"Join from this machine with: dfclient " +
                                 (local ? local->text() : host.joinArguments())};
  if (isHomeAlone(options.address)) {
    lines.push_back("From elsewhere nobody can join: it listens on " + host.address() + " alone. " +
                    openness.how_to_open);
    addOtherDoors(options, lines);
    return lines;
  }
  if (const auto link = host.joinLink(true)) lines.push_back("From elsewhere: dfclient " + link->text());
  if (const auto fingerprint = host.fingerprint()) {
    const std::string begin = options.link_host.empty()
                                  ? "From elsewhere with its name or address in place of the link's; its"
                                  : "Its";
    lines.push_back(begin + " key is " + fingerprint->text());
  }
  addOtherDoors(options, lines);
  const bool any = options.address == "::" || options.address == "0.0.0.0";
  lines.push_back(
      "Listening on " +
      (any ? "every address of this machine, port " + std::to_string(host.port()) : host.address()) +
      ", TCP and UDP. " + openness.how_to_restrict);
  return lines;
}

std::vector<std::string> qrLines(const HostOptions& options) {
  if (!options.qr) return {};
  std::vector<std::string> code = qrCode(options.web_address);
  if (!code.empty()) return code;
  return {"No QR code: this program was built without libqrencode."};
}

void writeWhereabouts(const HostOptions& options, const Host& host) {
  writeLine(options.port_file, "port", std::to_string(host.port()));
  if (host.metricsPort() != 0)
    writeLine(options.metrics_port_file, "metrics' port", std::to_string(host.metricsPort()));
  writeLine(options.join_file, "join", host.joinArguments());
}

}  // namespace naiad
