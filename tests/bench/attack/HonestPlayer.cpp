#include "HonestPlayer.h"

#include <algorithm>
#include <functional>
#include <variant>

#include "shared/replica/Acks.h"

namespace bench::attack {
namespace {

constexpr std::chrono::milliseconds kNoRush{250};  // after a longer pause, the keys missed in it are skipped

double millisBetween(HonestPlayer::Time from, HonestPlayer::Time to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

}  // namespace

HonestPlayer::HonestPlayer(asio::io_context& context, const Whereabouts& server, const std::string& name,
                           std::optional<Relay::Options> relay) {
  if (relay) m_relay = std::make_unique<Relay>(context, server.port, *relay);
  naiad::SessionOptions options;
  options.name = name;
  options.program = "naiad_attack";
  options.password = server.password;
  naiad::ServerTrust trust;
  trust.fingerprint = naiad::Fingerprint::parse(server.fingerprint);
  trust.known_servers = server.known_servers;
  const std::uint16_t port = m_relay ? m_relay->port() : server.port;
  m_connection = std::make_unique<naiad::Connection>(context, naiad::ServerAddress{"127.0.0.1", port},
                                                     options, true, trust);
  m_connection->onSession([this](naiad::ClientSession& session) {
    if (!m_observed) observe(session);
  });
  m_connection->start();
}

// Skips ticks without a snapshot, because with lost datagrams their pictures are unknown.
void HonestPlayer::observe(naiad::ClientSession& session) {
  m_observed = true;
  session.onBeforeSnapshot(
      [this, &session](std::uint32_t tick) { m_recorder.beforeSnapshot(session.replica(), tick); });
  session.onAfterSnapshot([this](const naiad::SnapshotHeader& header, const naiad::AckWindow& acks) {
    m_recorder.afterSnapshot(header, acks, true);
    if (!naiad::isNewer(header.tick, m_newest)) return;
    const Time now = std::chrono::steady_clock::now();
    if (m_news != Time{}) m_pause_ms = std::max(m_pause_ms, millisBetween(m_news, now));
    if (m_news != Time{}) m_news = now;
    m_newest = header.tick;
  });
}

void HonestPlayer::update(Time now) {
  m_connection->update(now);
  if (m_player == 0 && isJoined()) {
    m_player = session()->welcome().player;
    m_newest = session()->clock().newestTick();
    m_fingers.emplace(m_player, session()->replica().viewWidth(), session()->replica().viewHeight());
    m_next_tick = now;
  }
  if (m_player == 0) return;
  m_thrown_out = m_thrown_out || m_connection->isOver() || session()->welcome().player != m_player;
  if (!m_thrown_out && isJoined()) play(now);
}

void HonestPlayer::play(Time now) {
  if (now - m_next_tick > kNoRush) m_next_tick = now;
  while (now >= m_next_tick) {
    m_next_tick += session()->welcome().tick;
    for (const naiad::BotAction& action : m_fingers->tick()) {
      if (const auto* key = std::get_if<naiad::KeyAction>(&action)) {
        session()->sendKey(key->key, key->action, now);
      }
      if (const auto* click = std::get_if<naiad::BotClick>(&action)) {
        session()->sendMouse(click->action, click->button, click->x, click->y, now);
      }
    }
  }
}

bool HonestPlayer::isInItsSession() {
  return m_player != 0 && !m_thrown_out && isJoined() && !session()->isDetached();
}

bool HonestPlayer::isThrownOut() {
  return m_thrown_out || !isInItsSession();
}

void HonestPlayer::watchPauses(Time now) {
  m_news = now;
  m_pause_ms = 0;
}

double HonestPlayer::pauseMillis(Time now) const {
  return std::max(m_pause_ms, millisBetween(m_news, now));
}

void HonestPlayer::leave() {
  // If another session has replaced the first one, the replica of the first is gone.
  if (!m_thrown_out && session() != nullptr) m_recorder.finish(session()->replica());
  m_connection->leave();
}

}  // namespace bench::attack
