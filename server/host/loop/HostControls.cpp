#include "host/loop/HostControls.h"

#include <signal.h>

#include <asio/post.hpp>
#include <exception>
#include <memory>
#include <utility>

#include "host/loop/HostClients.h"
#include "host/loop/HostEndpoint.h"
#include "host/rounds/RoundHandover.h"
#include "shared/program/LineLog.h"

namespace naiad {

namespace {

ReloadResult readAgain(const Reload::ReadOptions& read, const HostOptions& now) {
  ReloadResult reloaded;
  try {
    reloaded.options = read();
    const HostOptions& next = reloaded.options;
    if (!next.password.empty() && next.password != now.password)
      reloaded.password = PasswordHash::fromText(next.password);
    if (!now.certificate.empty() && !next.certificate.empty())
      reloaded.identity = ServerIdentity::load(next.certificate, next.key);
  } catch (const std::exception& error) {
    reloaded.problem = error.what();
  }
  return reloaded;
}

const std::string kCannotHandOver = "Cannot keep the round: ";

}  // namespace

Reload::~Reload() {
  if (m_thread.joinable()) m_thread.join();
}

bool Reload::begin(const HostOptions& now, std::function<void(ReloadResult)> done) {
  if (m_reading.exchange(true)) return false;
  if (m_thread.joinable()) m_thread.join();
  m_thread = std::thread([this, now, done = std::move(done)] {
    done(readAgain(m_read, now));
    m_reading = false;
  });
  return true;
}

void HostControls::end(ShutdownScheduler::Plan plan) {
  RoomManager& rooms = m_clients.rooms();
  if (plan.at_round_end && (rooms.isPrivate() || rooms.isNamed()))
    plan.at_round_end = !(plan.when_empty = true);
  rooms.setLastRound(plan.at_round_end);
  m_hands_over_round = false;
  m_context.shutdown_scheduler.setPlan(std::move(plan), Clock::now());
}

void HostControls::endWhenEmpty(double seconds) {
  const auto timeout = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  end({.at = Clock::now() + timeout, .when_empty = true});
}

bool HostControls::cancelEnd() {
  m_clients.rooms().setLastRound(false);
  m_clients.rooms().forgetUpgrade();
  m_hands_over_round = false;
  return m_context.shutdown_scheduler.cancel();
}

void HostControls::update(Clock::time_point now) {
  if (const auto news = m_context.shutdown_scheduler.popNotice(now)) m_clients.broadcast(*news);
  restartForUpgrade(now);
}

// Restarts after an upgrade, because new worlds have another build than this server. Private worlds are
// played to their end first.
void HostControls::restartForUpgrade(Clock::time_point now) {
  const auto news = m_clients.rooms().popUpgradeMessage();
  if (!news) return;
  const bool waits = m_clients.rooms().isPrivate();
  m_context.log(LogEvent::warning(
      *news + (waits ? "; the server restarts when all players have left" : "; the server restarts now")));
  ShutdownScheduler::Plan plan =
      m_context.shutdown_scheduler.plan().value_or(ShutdownScheduler::Plan{.is_restart = true});
  if (waits) {
    plan.when_empty = true;
  } else {
    plan.at = now;
  }
  end(std::move(plan));
}

void HostControls::handleSignals(StopSignals& signals) {
  if (signals.count() > std::exchange(m_handled_signals, signals.count())) {
    const double drain_time = signals.signal() == SIGTERM ? m_context.options.drain_time : 0;
    endWhenEmpty(drain_time);
    if (drain_time > 0) m_context.log("SIGTERM: no new players; stopping when all players have left");
  }
  if (!signals.popHangup()) return;
  LineLog::reopenAll();
  m_context.log("SIGHUP: log reopened (the server has no terminal, so it keeps running)");
  if (!m_reload) return;
  if (m_on_reload) m_on_reload(false, Clock::now());
  reload([this](bool, const std::string& sentence) {
    if (m_on_reload) m_on_reload(true, Clock::now());
    m_context.log(sentence);
  });
}

// ---- options ----------------------------------------------------------------------------------------------

void HostControls::reload(Done done) {
  if (!m_reload) return done(false, "this server cannot reload its options");
  const bool began = m_reload->begin(m_context.options, [this, done](ReloadResult reloaded) {
    asio::post(m_context.home, [this, done, reloaded = std::make_shared<ReloadResult>(std::move(reloaded))] {
      applyReloaded(std::move(*reloaded), done);
    });
  });
  if (!began) done(false, "a reload is already in progress");
}

void HostControls::applyReloaded(ReloadResult reloaded, const Done& done) {
  if (!reloaded.problem.empty()) return done(false, "the options were not changed: " + reloaded.problem);
  if (reloaded.options.password != m_context.options.password)
    m_clients.admission().changePassword(std::move(reloaded.password));
  const OptionChanges changes = applyOptions(reloaded.options);
  if (reloaded.identity) m_endpoint.setIdentity(*std::move(reloaded.identity));
  done(true, "options reloaded: " + changes.text());
}

OptionChanges HostControls::applyOptions(const HostOptions& options) {
  OptionChanges changes = applyReloadable(options, m_context.options);
  m_clients.applyCapacityLimits();
  return changes;
}

// ---- the round --------------------------------------------------------------------------------------------

// A round in recovery cannot be handed over: its file counts servers that ended in one (RoundJournals.h).
std::string HostControls::handoverBlocker() const {
  return m_clients.rooms().recovering() ? "it is still being recovered" : "";
}

void HostControls::handOverRound(Done done) {
  if (m_p_handover == nullptr)
    return done(false, "Cannot keep the round: this requires dfserver with --journal");
  std::string why_not = m_p_handover->blocker();
  if (why_not.empty()) why_not = handoverBlocker();
  if (!why_not.empty()) return done(false, kCannotHandOver + why_not);
  m_context.log("replaying the round in the installed program while the game continues");
  m_p_handover->verify([this, done = std::move(done)](const RoundHandover::Result& result) {
    asio::post(m_context.home, [this, done, result] {
      if (!result.starts) return done(false, kCannotHandOver + result.problem);  // a restart would fail, too
      finishVerification(result.problem, done);
    });
  });
}

void HostControls::finishVerification(const std::string& problem, const Done& done) {
  if (m_is_draining) return done(false, "The server is shutting down");
  if (!problem.empty()) return endWithoutRound(problem, done);
  std::string why_not = m_p_handover->changeSinceVerification();
  if (why_not.empty()) why_not = handoverBlocker();
  if (!why_not.empty()) return done(false, kCannotHandOver + why_not);
  const std::string text = "The round resumes in the installed program";
  m_context.log("restart: " + text);
  end({.is_restart = true, .at = Clock::time_point()});
  m_hands_over_round = true;
  done(true, text);
}

// Ends the server, without its round, like a restart that waits until all players have left.
void HostControls::endWithoutRound(const std::string& problem, const Done& done) {
  const std::string text = "Cannot move the round to the installed program: " + problem;
  m_context.log(LogEvent::warning("restart: " + text + "; the server restarts when all players have left"));
  end({.is_restart = true, .when_empty = true});
  done(false, text + ". The server restarts when all players have left (unless \"cancel\" is given)");
}

bool HostControls::handsOverRound() const {
  return m_hands_over_round && m_context.shutdown_scheduler.isRestart();
}

void HostControls::beginDrain() {
  m_is_draining = true;
  if (handsOverRound()) m_p_handover->suspend(m_endpoint.port());
}

}  // namespace naiad
