#include "host/loop/NetworkReport.h"

#include "host/session/Counters.h"

namespace naiad {

void logPasswords(const PasswordCheck::Counters& passwords, const LogLine& log) {
  const std::string text = listCounters({{"right", passwords.right},
                                         {"wrong", passwords.wrong},
                                         {"unfit", passwords.unfit},
                                         {"too_many", passwords.too_many},
                                         {"busy", passwords.busy}});
  if (!text.empty()) log("passwords: " + text);
}

void logRefusals(const NetworkThread& network, const LogLine& log) {
  const TcpListener::Counters& streams = network.streamCounters();
  std::string text = listCounters({{"failed_accepts", streams.failed_accepts},
                                   {"handshakes_failed", streams.handshakes_failed},
                                   {"handshakes_late", streams.handshakes_late},
                                   {"half_open_ended", streams.half_open_ended},
                                   {"refused_half_open", streams.refused_half_open},
                                   {"refused_from_prefix", streams.refused_from_prefix},
                                   {"refused_too_often", streams.refused_too_often},
                                   {"refused_banned", streams.refused_banned}});
  if (!text.empty()) log("streams: " + text);
  const VisitorsListener::Counters visitors = network.visitorCounters();
  text = listCounters({{"visitors", visitors.visitors},
                       {"bad_headers", visitors.bad_headers},
                       {"late_headers", visitors.late_headers},
                       {"crowded", visitors.crowded},
                       {"refused_peers", visitors.refused_peers},
                       {"failed_accepts", visitors.failed_accepts}});
  if (!text.empty()) log("visitors' socket: " + text);
  const RelayCounters relay = network.counters();
  text = listCounters({{"datagrams_in_dropped", relay.datagrams_in_dropped},
                       {"datagrams_out_dropped", relay.datagrams_out_dropped},
                       {"streams_overflowed", relay.streams_overflowed},
                       {"streams_clogged", relay.streams_clogged},
                       {"unmet", relay.unmet},
                       {"keyless", relay.keyless}});
  if (!text.empty()) log("between the threads: " + text);
  if (!network.hasDatagrams()) return;
  const DatagramGateCounters gate = network.gateCounters();
  text = listCounters({{"delivered", gate.delivered},
                       {"too_short", gate.too_short},
                       {"too_long", gate.too_long},
                       {"bad_kind", gate.bad_kind},
                       {"unknown_id", gate.unknown_id},
                       {"session_flood", gate.session_flood},
                       {"claimed_flood", gate.claimed_flood},
                       {"prefix_flood", gate.prefix_flood},
                       {"stranger_flood", gate.stranger_flood},
                       {"refused", gate.refused}});
  if (!text.empty()) log("datagrams: " + text);
}

}  // namespace naiad
