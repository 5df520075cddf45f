#include "shared/fleet/ServerInfo.h"

#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

Json jsonOf(const ServerInfo& facts) {
  return {{"name", safeText(facts.name, ServerInfo::kMaxName)},
          {"game", safeText(facts.game, ServerInfo::kMaxName)},
          {"players", facts.players},
          {"max_players", facts.max_players},
          {"password", facts.requires_password},
          {"protocol", facts.protocol}};
}

}  // namespace naiad
