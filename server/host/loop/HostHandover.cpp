// A host that begins again in the program that is installed by now, and keeps its round (RoundHandover.h).
#include <asio/post.hpp>
#include <utility>

#include "host/loop/Host.h"
#include "host/rounds/RoundHandover.h"

namespace naiad {

namespace {

const std::string kCannotBeKept = "The round cannot be kept: ";

/// Servers that end while they execute a round are counted in its file (Journals.h).
constexpr const char* kIsRecovering = "it is being executed again already";

}  // namespace

void Host::keepRound(Reloading done) {
  if (m_p_handover == nullptr)
    return done(false, "No round can be kept here: that takes dfserver with --journal");
  if (const std::string why_not = m_p_handover->refusal(); !why_not.empty())
    return done(false, kCannotBeKept + why_not);
  if (m_rooms.recovering()) return done(false, kCannotBeKept + kIsRecovering);
  m_log("the round is executed again by the program that is installed, beside the game");
  m_p_handover->prove([this, done = std::move(done)](const RoundHandover::Result& result) {
    asio::post(m_io, [this, done, result] {
      if (!result.starts) return done(false, kCannotBeKept + result.problem);  // nor could it be begun later
      finishProof(result.problem, done);
    });
  });
}

void Host::finishProof(const std::string& problem, const Reloading& done) {
  if (m_is_draining) return done(false, "The server ends");
  if (!problem.empty()) return endWithoutRound(problem, done);
  if (const std::string change = m_p_handover->changeSinceProof(); !change.empty())
    return done(false, kCannotBeKept + change);
  if (m_rooms.recovering()) return done(false, kCannotBeKept + kIsRecovering);
  const std::string text = "The round goes on in the program that is installed";
  m_log("restart: " + text);
  end({.begins_again = true, .at = Clock::time_point()});
  m_keeps_round = true;
  done(true, text);
}

// As if players were asked to finish.
void Host::endWithoutRound(const std::string& problem, const Reloading& done) {
  const std::string text = "The round cannot go on in the program that is installed: " + problem;
  m_log(LogEvent::warning("restart: " + text + "; the server begins again when all have left"));
  end({.begins_again = true, .when_empty = true});
  done(false, text + ". The server restarts when all have left (cancel calls that off)");
}

}  // namespace naiad
