#include "shared/fleet/ServerFacts.h"

#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

Json jsonOf(const ServerFacts& facts) {
  return {{"name", safeText(facts.name, ServerFacts::kMaxName)},
          {"game", safeText(facts.game, ServerFacts::kMaxName)},
          {"players", facts.players},
          {"max_players", facts.max_players},
          {"password", facts.asks_password},
          {"protocol", facts.protocol}};
}

}  // namespace naiad
