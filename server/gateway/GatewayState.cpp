#include "server/gateway/GatewayState.h"

#include <utility>

#include "shared/json/Json.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::size_t kStreamsOfAPlayer = 2;
constexpr std::size_t kMaxShownName = 100;  // characters

/// A page has some ten files, for which browsers open six connections: a class that opens it at once, and
/// then 16 connections a second from one address.
constexpr PrefixAllowance::Rates kArrivals{{16, 1024}, {64, 4096}, std::nullopt};

std::string serverJson(const GatewaySettings& settings) {
  const std::string name = settings.name.empty() ? settings.link->where.host : settings.name;
  return "{\"name\": " + Json(safeText(name, kMaxShownName)).toString() +
         ", \"key\": " + Json(settings.link->key.text()).toString() + "}\n";
}

}  // namespace

GatewayState::GatewayState(GatewaySettings given, const AllowedNames& allowed, LogLine line)
    : settings(std::move(given)),
      names(allowed),
      page(settings.page),
      answers(page, names, serverJson(settings), !settings.certificate.empty()),
      server{settings.visitors, settings.link->key, TlsContext::forClient()},
      log(std::move(line)),
      arrivals(kArrivals),
      newcomers({settings.max_newcomers, settings.max_newcomers_per_address}),
      places(kStreamsOfAPlayer * settings.max_visitors, kStreamsOfAPlayer * settings.max_per_address) {}

}  // namespace naiad
