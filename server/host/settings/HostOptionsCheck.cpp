#include "host/settings/HostOptionsCheck.h"

#include <unistd.h>

#include <algorithm>
#include <asio/ip/address.hpp>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "host/settings/GameModule.h"
#include "host/settings/MetricsAddress.h"
#include "host/settings/RoomOptions.h"
#include "host/settings/SshDoor.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

constexpr int kMinFrameMicros = 1000;        // clients reject shorter ticks
constexpr std::size_t kMaxWebAddress = 300;  // the QR code of a longer one does not fit in a terminal

/// Returns why --in-process cannot be combined with another option; empty if it can.
std::string inProcessComplaint(const HostOptions& options) {
  if (!options.in_process) return {};
  if (usesJournal(options))
    return "--in-process cannot be used with --journal: only rounds of game processes are recorded";
  if (options.rooms.empty() && !usesWorldProcesses(options)) return {};
  return "--in-process cannot be used with --room, --on-game-over restart or --input-mode private: they "
         "require game processes";
}

/// Returns what is wrong with the metrics options; empty if they are valid.
std::string metricsComplaint(const HostOptions& options) {
  if (!MetricsHosts::parse(options.metrics_hosts))
    return "--metrics-hosts: expected host names, separated by commas";
  if (options.metrics.empty()) return {};
  const auto address = MetricsAddress::parse(options.metrics);
  if (!address) return "--metrics: expected a numeric ADDR:PORT, IPv6 in brackets";
  if (!address->is_private && !options.metrics_public)
    return "--metrics: " + address->address +
           " is not a loopback or private address; --metrics-public allows it";
  return {};
}

/// Returns what is wrong with the bus options; empty if they are valid.
std::string fleetComplaint(const HostOptions& options) {
  if (options.bus.empty()) {
    if (!options.bus_credentials.empty() || !options.bus_ca.empty() || !options.bus_id.empty())
      return "--bus-credentials, --bus-ca and --bus-id require --bus";
    return {};
  }
  if (!options.bus_id.empty() && !isServerId(options.bus_id))
    return "--bus-id: expected 1 to " + std::to_string(kMaxServerId) + " characters of a-z, 0-9 and '-'";
  return validateBusSettings({options.bus, options.bus_credentials, options.bus_ca});
}

bool isWebAddress(const std::string& text) {
  const bool begins = text.starts_with("https://") || text.starts_with("http://");
  return begins && text.size() <= kMaxWebAddress &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

/// Returns what is wrong with the addresses that are printed for players; empty if they are valid.
std::string announcementComplaint(const HostOptions& options) {
  if (!options.link_host.empty() && !LinkHost::parse(options.link_host))
    return "--public-host: expected HOST or HOST:PORT, IPv6 in brackets";
  if (!options.ssh_door.empty() && !SshDoor::parse(options.ssh_door))
    return "--ssh-door: expected USER@HOST or USER@HOST:PORT";
  if (!options.web_address.empty() && !isWebAddress(options.web_address))
    return "--web-address: expected https://… or http://… of at most 300 characters";
  if (options.qr && options.web_address.empty()) return "--qr requires --web-address";
  return {};
}

namespace fs = std::filesystem;

/// The use of a path: a file that is read, appended to, or replaced; a socket; a folder, which may be
/// missing.
enum class PathUse { kRead, kAppend, kReplace, kSocket, kFolder };

void requirePath(const fs::path& path, PathUse use) {
  const bool is_file = use == PathUse::kAppend || use == PathUse::kReplace;
  if (is_file && !fs::is_character_file(path)) requireRegular(path);
  fs::path used = fs::absolute(path);
  const bool is_folder = use > PathUse::kAppend || (use == PathUse::kAppend && !fs::exists(used));
  if (is_folder && use != PathUse::kFolder) used = used.parent_path();
  while (use == PathUse::kFolder && !fs::exists(used)) used = used.parent_path();
  if (is_folder) used /= ".";
  const int mode = is_folder ? W_OK | X_OK : use == PathUse::kRead ? R_OK : W_OK;
  if (::access(used.c_str(), mode) != 0)
    throw std::system_error(errno, std::generic_category(), used.lexically_normal().string());
}

void requireGame(const HostOptions& options) {
  if (!options.rooms.empty()) return;  // checked by validateRoomOptions()
  const fs::path module = GameModule::find(options.game);
  if (!fs::exists(module)) throw GameError("There is no game " + module.string() + ".");
}

void requireAddress(const HostOptions& options) {
  std::error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) throw std::runtime_error("\"" + options.address + "\" is not a numeric IPv4 or IPv6 address.");
  if (options.insecure && !address.is_loopback())
    throw std::runtime_error("--insecure: only loopback addresses are allowed.");
}

void requireIdentity(const HostOptions& options) {
  if (options.insecure) return;
  if (!options.certificate.empty()) return void(ServerIdentity::load(options.certificate, options.key));
  const fs::path own = options.identity;
  const fs::path folder = own.empty() ? ServerIdentity::defaultDirectory() : own;
  if (!fs::exists(folder / "certificate.pem")) return requirePath(folder, PathUse::kFolder);
  ServerIdentity::loadOrMake(folder, std::chrono::system_clock::now());  // makes none
}

// A password itself is not checked, because hashing it takes long.
void requireHashes(const HostOptions& options) {
  for (const std::string& password : {options.password, options.admin_password}) {
    if (password.starts_with("$argon2")) PasswordHash::fromText(password);
  }
}

}  // namespace

int reportDeploymentProblems(const HostOptions& options) {
  int result = 0;
  const auto check = [&result](int exit_code, const std::string& prefix, const auto& require) {
    try {
      require();
    } catch (const std::exception& error) {
      std::cerr << "dfserver: " << prefix << error.what() << "\n";
      result = result != 0 ? result : exit_code;
    }
  };
  check(3, "", [&options] { requireGame(options); });
  check(4, "", [&options] { requireAddress(options); });
  check(5, "", [&options] { requireIdentity(options); });
  check(5, "", [&options] { requireHashes(options); });
  const std::string journal = options.default_journal ? "" : options.journal;  // not required by default
  const fs::path control_folder = fs::path(options.control).parent_path();
  const struct {
    const char* p_option;
    std::string path;
    PathUse use;
    int exit_code = 5;
  } paths[] = {{"--log-file", options.log_file, PathUse::kAppend},
               {"--truth-file", options.truth_file, PathUse::kAppend},
               {"--port-file", options.port_file, PathUse::kReplace},
               {"--join-file", options.join_file, PathUse::kReplace},
               {"--status-file", options.status_file, PathUse::kReplace},
               {"--state", options.state, PathUse::kFolder},
               {"--journal", journal, PathUse::kFolder},
               {"--bus-credentials", options.bus_credentials, PathUse::kRead},
               {"--bus-ca", options.bus_ca, PathUse::kRead},
               {"--proxy-socket", options.visitors, PathUse::kSocket, 4},
               {"--control", control_folder.string(), PathUse::kFolder, 4}};
  for (const auto& one : paths) {
    if (one.path.empty()) continue;
    check(one.exit_code,
          std::string(one.p_option) + " cannot be used: ", [&one] { requirePath(one.path, one.use); });
  }
  return result;
}

std::string validateHostOptions(const HostOptions& options) {
  if (options.frame_micros != 0 && options.frame_micros < kMinFrameMicros) {
    return "--frame-time: " + std::to_string(options.frame_micros) + " is too short: expected 0, or " +
           std::to_string(kMinFrameMicros) + " or more";
  }
  if (std::string wrong = inProcessComplaint(options); !wrong.empty()) return wrong;
  if (options.certificate.empty() != options.key.empty())
    return "--certificate and --key must be used together";
  const std::pair<const char*, bool> encrypted[] = {{"--lan on", options.lan == "on"},
                                                    {"--proxy-socket", !options.visitors.empty()},
                                                    {"--certificate", !options.certificate.empty()}};
  for (const auto& [option, is_used] : encrypted) {
    if (options.insecure && is_used)
      return std::string(option) + " requires encryption: it cannot be used with --insecure";
  }
  if (std::string wrong = metricsComplaint(options); !wrong.empty()) return wrong;
  if (std::string wrong = fleetComplaint(options); !wrong.empty()) return wrong;
  if (std::string wrong = validateRoomOptions(options); !wrong.empty()) return wrong;
  return announcementComplaint(options);
}

}  // namespace naiad
