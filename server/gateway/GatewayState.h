// What the connections of one gateway share.
#pragma once

#include <memory>
#include <string>

#include "server/gateway/AllowedNames.h"
#include "server/gateway/GameLink.h"
#include "server/gateway/GatewaySettings.h"
#include "server/gateway/Guest.h"
#include "server/gateway/HttpAnswer.h"
#include "server/gateway/Newcomers.h"
#include "server/gateway/PageFiles.h"
#include "server/gateway/VisitorPlaces.h"
#include "shared/net/base/PrefixAllowance.h"
#include "shared/net/stream/VisitorFacts.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// Thread: the gateway's. Guests keep it as long as they live.
struct GatewayState : std::enable_shared_from_this<GatewayState> {
  GatewayState(GatewaySettings given, const AllowedNames& allowed, LogLine line);

  /// For a Guest.
  std::shared_ptr<Guests> sharedGuests() { return {shared_from_this(), &guests}; }

  const GatewaySettings settings;
  const AllowedNames names;
  const PageFiles page;
  const HttpAnswers answers;
  const GameServer server;
  std::shared_ptr<const TlsContext> tls;  ///< with browsers; null: plain HTTP
  GatewayCounters counters;
  ClientLog log;
  PrefixAllowance arrivals;
  Newcomers newcomers;
  VisitorPlaces places;
  Guests guests;
};

}  // namespace naiad
