// Which player somebody means who types #ID, a name, or the beginning of one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "shared/admin/AdminAnswer.h"

namespace naiad {

struct PlayerChoice {
  std::optional<AdminPlayer> player;  ///< nothing: `problem` says why
  AdminAnswer problem{};
};

/// In this order: #ID, which is never a name, so that a player who is called "#7" shields nobody; the whole
/// name; the whole name but for the case of letters; its beginning. Several that fit equally well are an
/// error that lists them.
PlayerChoice choosePlayer(const std::vector<AdminPlayer>& players, const std::string& typed);

}  // namespace naiad
