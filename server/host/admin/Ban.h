// One ban, or an exception to bans.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "shared/net/base/AddressRange.h"

namespace naiad {

struct Ban {
  using Time = std::chrono::system_clock::time_point;
  enum class Kind {
    kName,       ///< those who come with this name, or one that looks like it
    kRange,      ///< connections from these addresses
    kException,  ///< no ban of a range holds for these
  };

  std::uint64_t number = 0;  ///< as long as the server runs
  Kind kind = Kind::kName;
  std::string name{};                   ///< of kName
  std::optional<AddressRange> range{};  ///< of the others
  std::string reason{};
  std::string by{};             ///< who gave the command
  Time made{};                  ///< whole seconds
  std::optional<Time> until{};  ///< nothing: for ever
  bool lasting = true;          ///< kept on disk

  bool isOver(Time now) const { return until && *until <= now; }
  /// "name:Ann" or "192.0.2.0/24": bans of the same are one.
  std::string target() const { return kind == Kind::kName ? "name:" + name : range->text(); }
  bool isSameTarget(const Ban& other) const {
    return (kind == Kind::kException) == (other.kind == Kind::kException) && target() == other.target();
  }
};

/// For the banned: 'You are banned from this server until 2026-11-25 19:01 UTC: "spam".'
std::string banSentence(const Ban& ban);

}  // namespace naiad
