#include "Bots.h"

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "shared/net/stream/JoinLink.h"

namespace bench {

namespace {

constexpr std::chrono::milliseconds kTurn{5};
constexpr std::chrono::milliseconds kBetweenKeys{200};

naiad::SessionOptions optionsOf(int number) {
  naiad::SessionOptions options;
  options.name = "bot" + std::to_string(number);
  options.program = "naiad_fleet";
  options.columns = 80;
  options.rows = 24;
  return options;
}

}  // namespace

Bot::Bot(asio::io_context& context, const naiad::ServerAddress& directory, const naiad::ServerTrust& trust,
         int number)
    : m_connection(context, directory, optionsOf(number), true, trust),
      m_keys(static_cast<std::uint64_t>(number), 80, 24) {
  m_connection.start();
}

void Bot::update(Time now) {
  m_connection.update(now);
  if (m_redirected_at == Time() && m_connection.isRedirected()) m_redirected_at = now;
  const bool playing = isPlaying();
  if (m_was_playing && !playing) {
    ++m_losses;
    m_lost = true;
  }
  if (!m_was_playing && playing) {
    if (!m_redirect && m_redirected_at != Time())
      m_redirect = std::chrono::duration_cast<std::chrono::milliseconds>(now - m_redirected_at);
    if (m_killed_at != Time() && m_lost) m_back_at = now;
  }
  m_was_playing = playing;
  if (!playing || now < m_next_key) return;
  m_next_key = now + kBetweenKeys;
  for (const naiad::BotAction& action : m_keys.tick()) {
    if (const auto* const p_key = std::get_if<naiad::KeyAction>(&action))
      m_connection.session()->sendKey(p_key->key, p_key->action, now);
  }
}

void Bot::noteKill(Time now) {
  m_killed_at = now;
  m_back_at = {};
  m_lost = false;
  m_before = player();
  m_port_before = port();
}

Bots::Bots(const std::string& link, const std::filesystem::path& known_servers, int first, int count)
    : m_first(first), m_count(static_cast<std::size_t>(count)) {
  const auto parsed = naiad::JoinLink::parse(link);
  const auto* const p_link = std::get_if<naiad::JoinLink>(&parsed);
  if (p_link == nullptr) throw std::runtime_error("the directory has no link: " + link);
  m_directory = {p_link->where.host, p_link->where.port};
  m_trust.link_key = p_link->key;
  m_trust.known_servers = known_servers;
}

void Bots::serve() {
  const std::size_t waiting = m_bots.size() - playing();
  for (std::size_t i = waiting; i < m_at_once && m_bots.size() < m_count; ++i) {
    const int number = m_first + static_cast<int>(m_bots.size());
    m_bots.push_back(std::make_unique<Bot>(m_context, m_directory, m_trust, number));
  }
  m_context.restart();
  m_context.run_for(kTurn);
  const auto now = Bot::Clock::now();
  for (const auto& bot : m_bots) bot->update(now);
}

std::size_t Bots::playing() const {
  return static_cast<std::size_t>(
      std::count_if(m_bots.begin(), m_bots.end(), [](const auto& bot) { return bot->isPlaying(); }));
}

std::string Bots::problem() const {
  const auto over = std::find_if(m_bots.begin(), m_bots.end(), [](const auto& bot) { return bot->isOver(); });
  return over != m_bots.end() ? (*over)->sentence() : "";
}

void Bots::leaveAll() {
  for (const auto& bot : m_bots) bot->leave();
  m_context.restart();
  m_context.run_for(std::chrono::seconds(2));
}

}  // namespace bench
