// What a journal keeps of a player's session, so that the player comes back after the server was killed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "shared/values/Color.h"

namespace naiad {

/// Of a token, only its SHA-256 is kept (ResumeTokens.h). No address, no rights of an admin.
struct KeptSession {
  std::uint32_t player = 0;
  bool over = false;  ///< the player has left; the fields below say nothing
  bool muted = false;
  std::string name = {};  ///< kMaxKeptName bytes at most
  df::Color color = df::COLOR_DEFAULT;
  std::string newest = {};    ///< hash of the token that was issued last; empty: there is none
  std::string redeemed = {};  ///< hash of the one before, if it is still good
};
inline constexpr std::size_t kMaxKeptName = 256;
inline constexpr std::size_t kKeptHash = 32;  ///< bytes

}  // namespace naiad
