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

bool isWebAddress(const std::string& text) {
  const bool begins = text.starts_with("https://") || text.starts_with("http://");
  return begins && text.size() <= kMaxWebAddress &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
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

std::string validateHostOptions(const HostOptions& o) {
  const bool uses_worlds = !o.rooms.empty() || usesWorldProcesses(o);
  const auto metrics = MetricsAddress::parse(o.metrics);
  const std::string needs_tls = " requires encryption: it cannot be used with --insecure";
  const std::string needs_worlds = "--in-process cannot be used with ";
  const struct {
    bool is_wrong;
    std::string problem;
  } rules[] = {
      {o.frame_micros != 0 && o.frame_micros < kMinFrameMicros,
       "--frame-time: " + std::to_string(o.frame_micros) + " is too short: expected 0, or " +
           std::to_string(kMinFrameMicros) + " or more"},
      {o.in_process && usesJournal(o),
       needs_worlds + "--journal: only rounds of game processes are recorded"},
      {o.in_process && uses_worlds,
       needs_worlds + "--room, --on-game-over restart or --input-mode private: they require game processes"},
      {o.certificate.empty() != o.key.empty(), "--certificate and --key must be used together"},
      {o.insecure && o.lan == "on", "--lan on" + needs_tls},
      {o.insecure && !o.visitors.empty(), "--proxy-socket" + needs_tls},
      {o.insecure && !o.certificate.empty(), "--certificate" + needs_tls},
      {!MetricsHosts::parse(o.metrics_hosts), "--metrics-hosts: expected host names, separated by commas"},
      {!o.metrics.empty() && !metrics, "--metrics: expected a numeric ADDR:PORT, IPv6 in brackets"},
      {metrics && !metrics->is_private && !o.metrics_public,
       "--metrics: " + (metrics ? metrics->address : "") +
           " is not a loopback or private address; --metrics-public allows it"},
      {o.bus.empty() && !(o.bus_credentials + o.bus_ca + o.bus_id).empty(),
       "--bus-credentials, --bus-ca and --bus-id require --bus"},
      {!o.bus_id.empty() && !isServerId(o.bus_id),
       "--bus-id: expected 1 to " + std::to_string(kMaxServerId) + " characters of a-z, 0-9 and '-'"},
      {!o.bus.empty(), o.bus.empty() ? "" : validateBusSettings({o.bus, o.bus_credentials, o.bus_ca})},
      {true, validateRoomOptions(o)},
      {!o.link_host.empty() && !LinkHost::parse(o.link_host),
       "--public-host: expected HOST or HOST:PORT, IPv6 in brackets"},
      {!o.ssh_door.empty() && !SshDoor::parse(o.ssh_door),
       "--ssh-door: expected USER@HOST or USER@HOST:PORT"},
      {!o.web_address.empty() && !isWebAddress(o.web_address),
       "--web-address: expected https://… or http://… of at most 300 characters"},
      {o.qr && o.web_address.empty(), "--qr requires --web-address"}};
  for (const auto& [is_wrong, problem] : rules) {
    if (is_wrong && !problem.empty()) return problem;
  }
  return {};
}

}  // namespace naiad
