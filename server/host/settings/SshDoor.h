// An ssh door to a server, as its options name it (docs/doors.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/JoinLink.h"

namespace naiad {

/// USER@HOST[:PORT], where an ssh door is; port 22 if none is named.
struct SshDoor {
  std::string user;  ///< of letters, digits, '-' and '_': it is copied into shells
  LinkHost where;

  static std::optional<SshDoor> parse(std::string_view text);
  /// "ssh OPTIONS -p 2222 play@::1": OpenSSH 9.5 and later sends a decoy packet every 20 ms while the
  /// player types. The options disable that; older versions ignore them.
  std::string command() const;
};

}  // namespace naiad
