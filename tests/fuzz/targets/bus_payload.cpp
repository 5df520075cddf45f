// What comes from the bus, and from a sidecar: read within its bounds, or refused; and written out again it
// is the same.
//
//   input   0 a presence, 1 a result, 2 the sidecar's answer, 3 a line of its watch (1) | the text
#include <algorithm>
#include <string>

#include "Require.h"
#include "Script.h"
#include "host/fleet/GameServerFacts.h"
#include "shared/fleet/BusFields.h"
#include "shared/fleet/GameResult.h"
#include "shared/fleet/Presence.h"
#include "shared/fleet/ServerId.h"
#include "shared/net/base/SafeText.h"

namespace naiad::fuzz {
namespace {

void requirePresence(const std::string& text) {
  const auto presence = Presence::parse(text);
  if (!presence) return;
  REQUIRE(text.size() <= kMaxBusPayload);
  REQUIRE(isServerId(presence->id) && presence->port != 0);
  REQUIRE(safeText(presence->name, Presence::kMaxName) == presence->name);
  REQUIRE(safeText(presence->game, Presence::kMaxName) == presence->game);
  REQUIRE(presence->key.empty() || presence->key.size() == 64);
  REQUIRE(presence->host.empty() || presence->host.front() != '-');
  REQUIRE(presence->players <= 1'000'000 && presence->max_players <= 1'000'000);
  REQUIRE(Presence::parse(presence->payload()) == presence);
}

void requireResult(const std::string& text) {
  const auto result = GameResult::parse(text);
  if (!result) return;
  REQUIRE(text.size() <= kMaxBusPayload);
  REQUIRE(isServerId(result->server) && result->round.size() == 32 && result->number < 256);
  REQUIRE(!result->name.empty() && safeText(result->name, 16) == result->name);
  REQUIRE(result->points >= -1'000'000'000'000'000 && result->points <= 1'000'000'000'000'000);
  REQUIRE(!result->table.empty() && result->table.size() <= 32);
  REQUIRE(GameResult::parse(result->payload()) == result);
}

void requireFacts(const std::string& text, bool is_line) {
  const auto facts = GameServerFacts::parse(text, is_line);
  if (!facts) return;
  REQUIRE(facts->health_seconds >= 0 && facts->health_seconds <= 3600);
  for (const std::string* p_text : {&facts->name, &facts->state, &facts->address}) {
    REQUIRE(p_text->size() <= 253);
    REQUIRE(std::ranges::all_of(*p_text, [](char c) { return c > ' ' && c <= '~'; }));
  }
}

}  // namespace
}  // namespace naiad::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace naiad::fuzz;
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  switch (data[0] % 4) {
    case 0:
      requirePresence(text);
      break;
    case 1:
      requireResult(text);
      break;
    default:
      requireFacts(text, data[0] % 4 == 3);
  }
  return 0;
}
