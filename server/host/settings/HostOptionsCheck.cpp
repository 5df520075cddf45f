#include "host/settings/HostOptionsCheck.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "host/settings/MetricsAddress.h"
#include "host/settings/RoomOptions.h"
#include "host/settings/SshDoor.h"
#include "shared/fleet/BusPayloads.h"
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

}  // namespace

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
