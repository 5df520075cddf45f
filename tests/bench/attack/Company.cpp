#include "Company.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace bench::attack {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kJoinTime = 30s;
constexpr auto kReturnTime = 10s;
constexpr auto kServing = 20ms;    // time for which one call of serve() runs handlers
constexpr auto kFarDelay = 100ms;  // delay of the distant player in each direction

}  // namespace

Company::Company(Whereabouts server, std::string watched)
    : m_server(std::move(server)),
      m_watched(std::move(watched)),
      m_plain(m_context, m_server, "plain", std::nullopt),
      m_far(m_context, m_server, "far",
            Relay::Options{.source = "127.1.0.2", .delay = kFarDelay, .datagrams = true}),
      m_away(m_context, m_server, "away", Relay::Options{.source = "127.1.0.3", .datagrams = true}),
      m_newcomers(m_context, m_server) {}

void Company::serve() {
  m_context.restart();
  m_context.run_one_for(5ms);
  for (const auto enough = Clock::now() + kServing; Clock::now() < enough && m_context.poll_one() > 0;) {
  }
  const Clock::time_point now = Clock::now();
  for (HonestPlayer* p_player : {&m_plain, &m_far, &m_away}) p_player->update(now);
  m_newcomers.update(now);
  noteCrowd();
}

void Company::noteCrowd() {
  if (m_watched.empty() || !m_plain.isInItsSession()) return;
  const auto& players = m_plain.session()->players();
  const auto count = std::count_if(players.begin(), players.end(), [this](const naiad::PlayerLine& player) {
    return player.name.starts_with(m_watched);
  });
  m_crowd = std::max(m_crowd, static_cast<std::size_t>(count));
}

bool Company::areHere() {
  return m_plain.isInItsSession() && m_far.isInItsSession() && m_away.isInItsSession();
}

void Company::join() {
  for (const auto end = Clock::now() + kJoinTime; !areHere(); serve()) {
    for (HonestPlayer* p_player : {&m_plain, &m_far, &m_away}) {
      if (p_player->isOver() || Clock::now() > end)
        throw std::runtime_error("an honest player cannot join: " + p_player->message());
    }
  }
}

void Company::play(std::chrono::milliseconds lead, std::chrono::milliseconds duration, Absence absence) {
  for (const auto end = Clock::now() + lead; Clock::now() < end;) serve();
  const Clock::time_point begin = Clock::now();
  m_plain.watchPauses(begin);
  m_newcomers.begin(begin);
  bool cut = false;
  for (Clock::time_point now = begin; now < begin + duration; now = Clock::now()) {
    if (!cut && now >= begin + absence.from) {
      cut = true;
      m_away.relay()->setOpen(false);
      m_away.relay()->cut();
    }
    if (now >= begin + absence.until) m_away.relay()->setOpen(true);
    serve();
  }
  m_away.relay()->setOpen(true);
  m_newcomers.end();
  for (const auto end = Clock::now() + kReturnTime;
       Clock::now() < end && (m_newcomers.isBusy() || !areHere());) {
    serve();
  }
}

Fate Company::leave() {
  Fate fate;
  const Clock::time_point now = Clock::now();
  fate.pause_ms = m_plain.pauseMillis(now);
  fate.newcomers = m_newcomers.count();
  fate.newcomers_out = m_newcomers.failed();
  fate.newcomer_ms = m_newcomers.slowestMillis();
  fate.crowd = m_crowd;
  if (m_plain.session() != nullptr) fate.chat = m_plain.session()->counters().chat_lines;
  for (HonestPlayer* p_player : {&m_plain, &m_far, &m_away}) {
    fate.thrown_out += p_player->isThrownOut() ? 1 : 0;
    p_player->leave();
  }
  m_context.restart();
  m_context.run_for(500ms);
  return fate;
}

void Company::compare(const std::string& truth_file, Fate& fate) const {
  for (const HonestPlayer* p_player : {&m_plain, &m_far, &m_away}) {
    const naiad::TruthRecorder::Comparison compared = p_player->compare(truth_file);
    fate.wrong_cells += compared.wrong;
    fate.compared_ticks += compared.ticks;
  }
}

}  // namespace bench::attack
