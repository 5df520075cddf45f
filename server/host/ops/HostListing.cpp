#include "host/ops/HostListing.h"

#include <asio/ip/address.hpp>
#include <system_error>

#include "host/loop/HostClients.h"
#include "host/loop/HostEndpoint.h"
#include "host/session/CounterTable.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

HostListing::HostListing(const HostAccess& access)
    : m_access(access), m_lan(openLan()), m_status(openStatus()) {}

// Without encryption it is not to be found. Loopback alone is found only if that is asked for: it is no
// network with others in it.
std::unique_ptr<LanResponder> HostListing::openLan() const {
  const HostOptions& options = m_access.context.options;
  const bool automatic = options.lan == "auto";
  const bool loopback = asio::ip::make_address(options.address).is_loopback();
  const auto key = m_access.endpoint.fingerprint();
  if (!key || options.lan == "off" || (automatic && loopback)) return nullptr;
  try {
    const LanAnswer answer{m_access.clients.facts(), {}, m_access.endpoint.port(), ShortKey::of(*key)};
    return std::make_unique<LanResponder>(answer, options.address, automatic ? LanMode::kAuto : LanMode::kOn);
  } catch (const std::system_error& error) {
    const std::string wrong = std::string("cannot be found in the local network: ") + error.what();
    if (!automatic) throw ListenError("--lan on: the server " + wrong + ".", error.code());
    m_access.context.log({LogEvent::Level::kWarning, "warning: the server " + wrong});
    return nullptr;
  }
}

std::unique_ptr<StatusFile> HostListing::openStatus() const {
  const HostOptions& options = m_access.context.options;
  if (options.status_file.empty()) return nullptr;
  const auto link = options.link_host.empty() ? std::nullopt : m_access.endpoint.joinLink(true);
  return std::make_unique<StatusFile>(options.status_file, m_access.clients.facts(),
                                      link ? link->text() : std::string());
}

void HostListing::begin() {
  if (m_lan) m_lan->start();
}

void HostListing::tick(Clock::time_point) {
  const std::size_t playing = m_access.clients.sessions().playing();
  if (m_lan) m_lan->setPlayers(playing);
  if (!m_status) return;
  m_status->setPlayers(static_cast<std::uint32_t>(playing));
  if (const std::string news = m_status->takeNews(); !news.empty()) m_access.context.log(news);
}

void HostListing::drain() {
  if (m_lan) m_lan->stop();
  m_status.reset();
}

void HostListing::finish() {
  if (!m_lan) return;
  const LanCounters lan = m_lan->counters();
  const std::string text = listCounters({{"answered", lan.answered},
                                         {"routed", lan.routed},
                                         {"foreign", lan.foreign},
                                         {"malformed", lan.malformed},
                                         {"too_often", lan.too_often},
                                         {"unsent", lan.unsent}});
  if (!text.empty()) m_access.context.log("local network: " + text);
}

}  // namespace naiad
