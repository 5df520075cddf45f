#include "Bot.h"

#include <cstdio>
#include <utility>

namespace naiad::soak {

namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds kFirstBackoff{250};
constexpr std::chrono::milliseconds kMaxBackoff{2000};
/// A client that should receive snapshots counts as stuck after this time without a new one.
constexpr std::chrono::seconds kStuck{3};
/// Like kStuck, for a client without datagrams: a stream waits for its timers before it sends again.
constexpr std::chrono::seconds kStuckOnStream{15};

}  // namespace

Bot::Bot(Place place, int number, std::uint64_t seed, double haste, OnSnapshot on_snapshot)
    : m_place(place),
      m_number(number),
      m_random(seed),
      m_on_snapshot(std::move(on_snapshot)),
      m_weather(m_random.next(), haste),
      m_player(m_random.next(), 80, 24),
      m_next_attempt(now() + std::chrono::milliseconds(m_random.below(2000))),
      m_calm_since(m_next_attempt),
      m_news_at(m_next_attempt) {}

std::uint32_t Bot::player() const {
  return m_shown.session ? m_shown.session->welcome().player : 0;
}

// ---- joining and rejoining

void Bot::attempt() {
  if (!m_connecting) {  // first waits for the two round trips that TCP and TLS take
    m_connecting = true;
    m_next_attempt = now() + 2 * (m_weather.up().delay + m_weather.down().delay);
    return;
  }
  m_connecting = false;
  if (m_weather.isOutage()) return tryAgain();
  m_next_attempt = Time::max();
  attach();
}

void Bot::tryAgain() {
  m_next_attempt = now() + m_backoff;
  m_backoff = std::min(m_backoff * 2, kMaxBackoff);
}

std::unique_ptr<ClientSession> Bot::makeSession(std::unique_ptr<ReliableChannel> channel, Seat& seat) {
  SessionOptions options;
  options.name = "bot" + std::to_string(m_number);
  options.program = "soak";
  if (m_shown.session && m_shown.session->isDetached()) {
    options.resume_token = m_shown.session->welcome().resume_token;
    options.last_frame = m_shown.session->receivedFrames();
  }
  options.now = [this] { return now(); };
  auto opened = std::make_shared<const DatagramSocket*>(nullptr);
  m_p_opened = opened;
  options.open_socket = [this, opened](const Endpoint&) {
    const std::string host =
        "10.1." + std::to_string(m_number / 200) + "." + std::to_string(1 + m_number % 200);
    std::unique_ptr<DatagramSocket> socket = m_place.network.open(*makeEndpoint(host, 0));
    *opened = socket.get();
    Seat fresh;
    fresh.p_socket = socket.get();
    applyTo(fresh);
    return socket;
  };
  seat.p_socket = nullptr;
  return std::make_unique<ClientSession>(std::move(channel), options, now());
}

void Bot::attach() {
  m_pending.link = std::make_unique<VirtualStreamLink>(m_place.clock, LinkConditions{}, m_random.next());
  applyTo(m_pending);
  auto channel = m_pending.link->takeEnd(LinkEnd::kClient, toString(m_place.server));
  ReliableChannel& started = *channel;
  const ReliableChannel* p_channel = channel.get();
  m_place.host.accept(
      m_pending.link->takeEnd(LinkEnd::kServer, "10.1.0.1:" + std::to_string(1000 + m_number)));
  m_pending.session = makeSession(std::move(channel), m_pending);
  m_pending.session->onAfterSnapshot(
      [this, p_session = m_pending.session.get()](const SnapshotHeader& header, const AckWindow& acks) {
        ++m_place.tally.snapshots;
        if (p_session == m_shown.session.get()) m_on_snapshot(*this, header, acks);
      });
  const auto owner = [this, p_channel]() -> ClientSession* {
    for (Seat* seat : {&m_pending, &m_shown}) {
      if (seat->session && seat->session->owns(p_channel)) return seat->session.get();
    }
    return nullptr;
  };
  started.start({[this, owner](std::string_view frame) {
                   ClientSession* session = owner();
                   if (session == nullptr) return;
                   session->receive(frame, now());
                   if (session == m_pending.session.get() && session->isResumed()) checkPending();
                 },
                 [this, owner](CloseReason reason) {
                   if (ClientSession* session = owner()) session->closed(reason);
                 }});
}

void Bot::checkPending() {
  ClientSession& pending = *m_pending.session;
  using S = ClientSession::State;
  if (m_p_opened) m_pending.p_socket = *m_p_opened;
  if (pending.isResumed() && m_shown.session && m_shown.session->isDetached()) {
    m_shown.session->adopt(pending, now());
    m_shown.link = std::move(m_pending.link);
    m_pending = {};
    m_backoff = kFirstBackoff;
    ++m_place.tally.resumed;
    return;
  }
  if (pending.state() == S::kPlaying && pending.hasPicture(now())) {
    if (m_shown.session) ++m_place.tally.lost_sessions;
    m_shown = std::move(m_pending);
    m_pending = {};
    forgetInputs();
    m_backoff = kFirstBackoff;
    m_snapshots_seen = 0;
    ++m_place.tally.joins;
    return;
  }
  if (!pending.isOver()) return;
  if (pending.state() != S::kLost) {
    ++m_place.tally.thrown_out;
    std::fprintf(stderr, "bot %d not let in: %s\n", m_number, pending.message().c_str());
  }
  m_pending = {};
  tryAgain();
}

void Bot::checkShown() {
  ClientSession& shown = *m_shown.session;
  using S = ClientSession::State;
  const bool seeking = m_pending.session != nullptr || m_next_attempt != Time::max();
  if (!seeking && (shown.isDetached() || shown.state() == S::kLost)) m_next_attempt = now();
  if (!shown.isOver() || shown.state() == S::kLost) return;
  ++m_place.tally.thrown_out;
  std::fprintf(stderr, "%.1f s: bot %d was thrown out: %s\n",
               static_cast<double>(m_place.clock.now().count()) / 1e6, m_number, shown.message().c_str());
  quit(1s);
}

void Bot::update() {
  if (m_shown.session) m_shown.session->update(now());
  if (m_pending.session) {
    m_pending.session->update(now());
    checkPending();
  }
  if (m_shown.session) checkShown();
  if (now() >= m_next_attempt) attempt();
}

// ---- network conditions and events

void Bot::applyTo(const Seat& seat) const {
  if (seat.link) {
    seat.link->setConditions(LinkEnd::kClient, m_weather.streamUp());
    seat.link->setConditions(LinkEnd::kServer, m_weather.streamDown());
  }
  if (seat.p_socket == nullptr) return;
  m_place.network.setConditions(*seat.p_socket, m_place.host.socket(), m_weather.up());
  m_place.network.setConditions(m_place.host.socket(), *seat.p_socket, m_weather.down());
  m_place.network.block(*seat.p_socket, m_weather.blocksUp(), m_weather.blocksDown());
}

void Bot::applyWeather() {
  if (m_pending.session && m_p_opened) m_pending.p_socket = *m_p_opened;
  applyTo(m_shown);
  applyTo(m_pending);
}

// Disappears without a message to the server, and joins again after `pause`.
void Bot::quit(std::chrono::milliseconds pause) {
  m_shown = {};
  m_pending = {};
  forgetInputs();
  m_connecting = false;
  m_backoff = kFirstBackoff;
  m_snapshots_seen = 0;
  m_next_attempt = m_calm_since = m_news_at = now() + pause;
}

void Bot::strike(const Strokes& strokes) {
  if (strokes.changed) applyWeather();
  if (strokes.healed) m_calm_since = std::max(m_calm_since, now());
  if (m_shown.session == nullptr) return;
  if (strokes.rebind && m_shown.p_socket != nullptr) {
    Endpoint address = m_shown.p_socket->localEndpoint();
    address.port = 0;
    m_place.network.rebind(*m_shown.p_socket, address);
    ++m_place.tally.rebound;
    m_calm_since = std::max(m_calm_since, now());
  }
  if (strokes.break_stream && m_shown.link) {
    m_shown.link->breakConnection();
    ++m_place.tally.broken;
    m_calm_since = std::max(m_calm_since, now());
  }
  if (strokes.kill) {
    ++m_place.tally.killed;
    return quit(std::chrono::milliseconds(500 + m_random.below(20'000)));
  }
  if (strokes.leave) {
    ++m_place.tally.left;
    m_shown.session->leave();
    quit(std::chrono::milliseconds(500 + m_random.below(5'000)));
  }
}

void Bot::rest() {
  m_resting = true;
  m_weather.heal();
  m_calm_since = std::max(m_calm_since, now());
  applyWeather();
}

// ---- playing

void Bot::press() {
  ClientSession& session = *m_shown.session;
  for (const BotAction& action : m_player.tick()) {
    Heard sent{player(), false, 0, 0};
    bool went = false;
    if (const auto* key = std::get_if<KeyAction>(&action)) {
      sent.what = key->key;
      sent.action = key->action;
      went = session.sendKey(key->key, key->action, now());
    } else if (const auto* click = std::get_if<BotClick>(&action)) {
      sent = {player(), true, click->button, click->action};
      went = session.sendMouse(click->action, click->button, click->x, click->y, now());
    }
    ++(went ? m_place.tally.inputs : m_place.tally.inputs_dropped);
    if (went) m_unheard.push_back(sent);
  }
  if (m_random.below(3000) == 0) session.sendChat("all is well with " + std::to_string(m_number));
}

// A release may arrive twice, because the server releases the keys of a disconnected player, possibly before
// the player's own release arrives.
void Bot::heard(const Heard& what) {
  const bool is_release = !what.is_mouse && what.action == df::KEY_RELEASED;
  const bool is_next = !m_unheard.empty() && m_unheard.front().what == what.what &&
                       m_unheard.front().action == what.action && m_unheard.front().is_mouse == what.is_mouse;
  if (!is_next) {
    if (is_release && m_down.erase(what.what) + m_let_go.erase(what.what) > 0) return;
    ++m_place.tally.inputs_wrong;
    return;
  }
  m_unheard.pop_front();
  if (what.is_mouse) return;
  if (!is_release) {
    m_down.insert(what.what);
    return;
  }
  m_down.erase(what.what);
  const Session* far = m_place.host.find(player());
  if (far != nullptr && far->isDetached()) m_let_go.insert(what.what);
}

void Bot::forgetInputs() {
  m_unheard.clear();
  m_down.clear();
  m_let_go.clear();
}

void Bot::watch() {
  const std::uint64_t seen = m_shown.session ? m_shown.session->counters().snapshots : 0;
  if (seen != m_snapshots_seen) m_news_at = now();
  m_snapshots_seen = seen;
  if (m_weather.isOutage()) m_calm_since = std::max(m_calm_since, now());
  const auto patience = m_weather.isBlocked() || m_shown.p_socket == nullptr ? kStuckOnStream : kStuck;
  if (now() - std::max(m_news_at, m_calm_since) < patience) return;
  ++m_place.tally.stuck;
  m_news_at = now();
  std::fprintf(stderr, "stuck: %s\n", describe().c_str());
}

void Bot::tick() {
  strike(m_weather.tick(m_place.clock.now()));
  if (m_shown.session && !m_resting && m_shown.session->state() == ClientSession::State::kPlaying) press();
  watch();
}

std::string Bot::describe() const {
  const double seconds = static_cast<double>(m_place.clock.now().count()) / 1e6;
  std::string text = std::to_string(seconds) + " s: bot " + std::to_string(m_number);
  if (m_weather.isBlocked()) text += m_weather.blocksUp() ? " blocked up" : " blocked down";
  text += " loss " + std::to_string(m_weather.up().loss) + " " + std::to_string(m_weather.down().loss);
  text += " rate " + std::to_string(m_weather.up().rate) + " " + std::to_string(m_weather.down().rate);
  if (m_pending.session) text += " pending " + std::to_string(static_cast<int>(m_pending.session->state()));
  if (!m_shown.session) return text + " no session";
  const ClientSession& session = *m_shown.session;
  text += " state " + std::to_string(static_cast<int>(session.state())) +
          (session.isDetached() ? " detached" : "") +
          (session.hasDatagrams(now()) ? " datagrams" : " no datagrams") + " player " +
          std::to_string(player());
  const Session* far = m_place.host.find(player());
  if (far == nullptr) return text + " the server has no such session";
  return text + (far->isDetached() ? " far detached" : "") +
         (far->transport().isOpen(now()) ? " far open" : " far closed") + " rtt " +
         std::to_string(far->transport().roundTrip().count());
}

}  // namespace naiad::soak
