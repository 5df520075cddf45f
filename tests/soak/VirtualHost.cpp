#include "VirtualHost.h"

#include <algorithm>
#include <utility>

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/WorldStore.h"
#include "host/session/NameSanitizer.h"
#include "naiad.pb.h"

namespace naiad::soak {

namespace {

constexpr std::chrono::seconds kGrace{60};
constexpr std::uint32_t kPlayerListEvery = 15;

KeyExporter exporterOf(const Session& session) {
  return [&session](std::string_view label, std::string_view context, std::size_t bytes) {
    return session.exportSecret(label, context, bytes);
  };
}

}  // namespace

VirtualHost::VirtualHost(df::World& world, const VirtualClock& clock, VirtualNetwork& network,
                         const Endpoint& address, std::uint64_t seed)
    : m_world(world), m_clock(clock), m_random(seed) {
  std::unique_ptr<DatagramSocket> socket = network.open(address);
  m_p_socket = socket.get();
  m_datagrams = std::make_unique<DatagramService>(
      std::move(socket), [this] { return timeOf(m_clock); }, [this] { return m_random.next(); });
}

template <class Visit>
void VirtualHost::forEachPlaying(Visit visit) const {
  for (const auto& session : m_sessions) {
    if (session->state() == Session::State::kPlaying) visit(*session);
  }
}

void VirtualHost::accept(std::unique_ptr<ReliableChannel> channel) {
  ++m_counters.connections;
  m_sessions.push_back(std::make_unique<Session>(std::move(channel), m_counters, timeOf(m_clock)));
  m_sessions.back()->setId(m_next_session++);
  m_sessions.back()->start({[this](Session& session, const wire::Hello& hello) { greet(session, hello); },
                            [this](Session& session, const std::string& text) { chat(session, text); },
                            [this](Session& session) {
                              m_tokens.forget(session.id());
                              if (session.player() != 0) m_world.input().leave(session.player());
                            },
                            [this] { return timeOf(m_clock); }});
}

void VirtualHost::greet(Session& session, const wire::Hello& hello) {
  if (!resume(session, hello)) admit(session, hello);
}

bool VirtualHost::resume(Session& session, const wire::Hello& hello) {
  if (hello.resume_token().empty()) return false;
  const std::uint64_t id = m_tokens.redeem(hello.resume_token()).value_or(0);  // 0 is not a player
  const auto found = std::find_if(m_sessions.begin(), m_sessions.end(),
                                  [id](const auto& other) { return other->id() == id; });
  if (found == m_sessions.end() || (*found)->state() != Session::State::kPlaying) return false;
  Session& before = **found;
  wire::Welcome welcome = before.welcomed();
  welcome.set_resumed(true);
  welcome.set_tick(m_publisher.tick());
  welcome.set_resume_token(m_tokens.issue(before.id()));
  welcome.set_aead(0);
  if (SealedChannel* datagrams = before.datagrams()) {
    const Epoch epoch = datagrams->epoch() + 1;
    if (datagrams->renew(*session.stream(), epoch)) {
      welcome.set_aead(static_cast<std::uint32_t>(datagrams->aead()));
      welcome.set_epoch(epoch);
    }
  }
  before.resumeOn(session, welcome, hello.last_frame());
  return true;
}

void VirtualHost::admit(Session& session, const wire::Hello& hello) {
  std::vector<std::string> taken;
  forEachPlaying([&](const Session& other) { taken.push_back(other.name()); });
  const std::string name = uniqueName(cleanName(hello.player_name()), taken);
  const auto color = static_cast<df::Color>(1 + m_counters.joined++ % 7);
  wire::Welcome welcome;
  welcome.set_player(m_world.input().join(name, color));
  welcome.set_name(name);
  welcome.set_game("soak");
  welcome.set_tick_micros(33333);
  welcome.set_view_width(static_cast<std::uint32_t>(m_world.views().width()));
  welcome.set_view_height(static_cast<std::uint32_t>(m_world.views().height()));
  welcome.set_color(static_cast<std::uint32_t>(color));
  welcome.set_tick(m_publisher.tick());
  std::unique_ptr<DatagramService::Channel> datagrams;
  if (hello.aeads_size() > 0)
    datagrams = m_datagrams->open(exporterOf(session), *aeadFromWire(hello.aeads(0)));
  if (datagrams) {
    welcome.set_connection_id(datagrams->id());
    welcome.set_aead(static_cast<std::uint32_t>(datagrams->aead()));
    welcome.set_epoch(datagrams->epoch());
  }
  session.setGrace(kGrace);
  welcome.set_resume_token(m_tokens.issue(session.id()));
  session.welcome(welcome, std::move(datagrams));
  m_players_told.clear();
}

void VirtualHost::chat(const Session& session, const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_player(session.player());
  message.mutable_chat()->set_text(text);
  forEachPlaying([&](Session& other) { other.sendReliable(message); });
}

void VirtualHost::tick(const std::function<void()>& on_ticked) {
  std::erase_if(m_sessions, [](const auto& session) { return session->state() == Session::State::kGone; });
  const bool watched = playing() > 0;
  if (watched && !m_world.store().isWatched()) m_publisher = Publisher();
  m_world.store().setWatched(watched);
  for (const auto& session : m_sessions) {
    session->checkDeadlines(timeOf(m_clock));
    if (session->popWelcomeConfirmed()) m_tokens.confirm(session->id());
  }
  applyInputs();
  m_world.tick();
  ++m_counters.ticks;
  if (watched) {
    m_publisher.update(m_world.picture().view());
    on_ticked();
    sendSnapshots();
    sendPlayers();
  }
  m_datagrams->flush();
}

void VirtualHost::applyInputs() {
  const std::uint32_t next = m_world.picture().view().tick + 1;
  forEachPlaying([this, next](Session& session) {
    session.drainInputs(next, [&](const Input& input) {
      if (input.is_mouse) {
        m_world.input().mouse(session.player(), static_cast<df::EventMouseAction>(input.action),
                              static_cast<df::Mouse::Button>(int{input.button} - 1), input.x, input.y);
      } else {
        m_world.input().key(session.player(), static_cast<df::Keyboard::Key>(input.key),
                            static_cast<df::EventKeyboardAction>(input.action));
      }
    });
  });
}

void VirtualHost::sendSnapshots() {
  for (const df::PlayerFacts& player : m_world.picture().view().players) {
    Session* session = find(player.id);
    if (session == nullptr) continue;
    session->setControls(player.steering.p_table);
    session->sendTick(m_publisher, player);
  }
}

void VirtualHost::sendPlayers() {
  if (m_publisher.tick() % kPlayerListEvery != 0) return;
  wire::ServerMessage message;
  for (const df::PlayerFacts& player : m_world.picture().view().players) {
    wire::PlayerEntry& entry = *message.mutable_players()->add_players();
    entry.set_player(player.id);
    entry.set_name(player.name);
    entry.set_color(static_cast<std::uint32_t>(player.color));
    entry.set_score(player.score);
  }
  std::string bytes = message.SerializeAsString();
  if (bytes == m_players_told) return;
  m_players_told = std::move(bytes);
  forEachPlaying([&](Session& session) { session.sendReliable(message); });
}

Session* VirtualHost::find(std::uint32_t player) const {
  const auto found = std::find_if(m_sessions.begin(), m_sessions.end(), [player](const auto& session) {
    return session->state() == Session::State::kPlaying && session->player() == player;
  });
  return found != m_sessions.end() ? found->get() : nullptr;
}

std::size_t VirtualHost::playing() const {
  std::size_t count = 0;
  forEachPlaying([&count](const Session&) { ++count; });
  return count;
}

}  // namespace naiad::soak
