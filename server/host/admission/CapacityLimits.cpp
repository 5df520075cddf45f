#include "host/admission/CapacityLimits.h"

#include <algorithm>

#include "host/rooms/RoomManager.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

/// Limits of half-open connections. Per prefix, they allow a school class behind one address, or the host's
/// limit per address; in total, a few such groups, or all players when they reconnect at once. Each
/// connection takes up to 192 KiB.
constexpr std::size_t kMinHalfOpenPerPrefix = 64;
constexpr std::size_t kMinHalfOpen = 256;
constexpr std::size_t kMaxHalfOpen = 2048;

/// Number of open files other than connections, such as libraries and logs.
constexpr std::size_t kOtherFiles = 256;

/// Returns the number of files for worlds. A private world needs its socket and its supervisor's. A room's
/// world also needs one for its output, and all three twice while a new world replaces the old one.
std::size_t worldFiles(const HostOptions& options) {
  if (!options.rooms.empty()) return 6 * kMaxRooms;
  return options.players == "private" ? 2 * RoomManager::maxWorlds(options) : 0;
}

}  // namespace

std::size_t maxConnections(const HostOptions& options) {
  return static_cast<std::size_t>(options.max_players) * 2 + 16;
}

HalfOpenQuota halfOpenQuota(const HostOptions& options) {
  const auto players = static_cast<std::size_t>(options.max_players);
  const auto per_address = static_cast<std::size_t>(options.max_per_address);
  HalfOpenQuota places;
  places.total = std::clamp(2 * per_address, kMinHalfOpen, kMaxHalfOpen);
  places.known = std::clamp(players, places.total, kMaxHalfOpen);
  places.per_prefix = std::clamp(per_address, kMinHalfOpenPerPrefix, places.total / 2);
  return places;
}

std::size_t requiredOpenFiles(const HostOptions& options) {
  const HalfOpenQuota half_open = halfOpenQuota(options);
  return maxConnections(options) + static_cast<std::size_t>(options.max_players) +  // for second streams
         half_open.total + half_open.known + worldFiles(options) + kOtherFiles;
}

}  // namespace naiad
