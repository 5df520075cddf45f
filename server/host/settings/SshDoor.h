// The address of an ssh door to a server (--ssh-door, docs/doors.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/JoinLink.h"

namespace naiad {

/// The address USER@HOST[:PORT] of an ssh door; the default port is 22.
struct SshDoor {
  std::string user;  ///< only letters, digits, '-' and '_', because users paste it into shells
  LinkHost where;

  static std::optional<SshDoor> parse(std::string_view text);
  /// Returns "ssh OPTIONS -p 2222 play@::1". The options disable the decoy packets that OpenSSH 9.5 and later
  /// sends every 20 ms while the player types; older versions ignore them.
  std::string command() const;
};

}  // namespace naiad
