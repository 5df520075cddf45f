#include "host/settings/HostOptionsCheck.h"

#include <algorithm>
#include <cstddef>

#include "host/settings/MetricsAddress.h"
#include "host/settings/RoomList.h"
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
  if (wantsJournal(options))
    return "--in-process goes without --journal: rounds are written down of games in processes of their own";
  if (options.rooms.empty() && !wantsWorlds(options)) return {};
  return "--in-process is not for --room, --on-game-over restart or --players private: each of their worlds "
         "has a process of its own";
}

/// Returns the problem of the metrics options; empty if they are valid.
std::string metricsComplaint(const HostOptions& options) {
  if (!MetricsHosts::parse(options.metrics_hosts))
    return "--metrics-hosts: names with commas between are wanted";
  if (options.metrics.empty()) return {};
  const auto address = MetricsAddress::parse(options.metrics);
  if (!address) return "--metrics: a numeric ADDR:PORT is wanted, IPv6 in brackets";
  if (!address->is_private && !options.metrics_public)
    return "--metrics: everybody could read them on " + address->address +
           ", which is no address of loopback or of a private network; --metrics-public lets them";
  return {};
}

/// Returns the problem of the bus options; empty if they are valid.
std::string fleetComplaint(const HostOptions& options) {
  if (options.bus.empty()) {
    if (!options.bus_credentials.empty() || !options.bus_ca.empty() || !options.bus_id.empty())
      return "--bus-credentials, --bus-ca and --bus-id are for --bus, which is not given";
    return {};
  }
  if (!options.bus_id.empty() && !isServerId(options.bus_id))
    return "--bus-id: 1 to " + std::to_string(kMaxServerId) + " of a-z, 0-9 and '-' are wanted";
  return busComplaint({options.bus, options.bus_credentials, options.bus_ca});
}

bool isWebAddress(const std::string& text) {
  const bool begins = text.starts_with("https://") || text.starts_with("http://");
  return begins && text.size() <= kMaxWebAddress &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

/// Returns the problem of the addresses that are printed for players; empty if they are valid.
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

}  // namespace

std::string optionsComplaint(const HostOptions& options) {
  if (options.frame_micros != 0 && options.frame_micros < kMinFrameMicros) {
    return "--frame-time: " + std::to_string(options.frame_micros) + " is neither 0 nor " +
           std::to_string(kMinFrameMicros) + " or more";
  }
  if (std::string wrong = inProcessComplaint(options); !wrong.empty()) return wrong;
  if (options.certificate.empty() != options.key.empty()) return "--certificate and --key come together";
  if (options.insecure && options.lan == "on") return "--lan on needs encryption, so not --insecure";
  if (options.insecure && !options.visitors.empty()) return "--visitors needs encryption, so not --insecure";
  if (std::string wrong = metricsComplaint(options); !wrong.empty()) return wrong;
  if (std::string wrong = fleetComplaint(options); !wrong.empty()) return wrong;
  if (std::string wrong = roomsComplaint(options); !wrong.empty()) return wrong;
  return announcementComplaint(options);
}

}  // namespace naiad
