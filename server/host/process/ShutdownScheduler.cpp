#include "host/process/ShutdownScheduler.h"

#include <utility>

namespace naiad {

namespace {

std::string inSeconds(ShutdownScheduler::Time at, ShutdownScheduler::Time now) {
  const auto left = std::chrono::ceil<std::chrono::seconds>(at - now).count();
  return "in " + std::to_string(left) + (left == 1 ? " second" : " seconds");
}

}  // namespace

void ShutdownScheduler::setPlan(Plan plan, Time now) {
  m_plan = std::move(plan);
  m_announced = false;
  m_final_notice_given = !m_plan->at || *m_plan->at - now <= kFinalNotice;
}

bool ShutdownScheduler::cancel() {
  return std::exchange(m_plan, std::nullopt).has_value();
}

bool ShutdownScheduler::isDue(Time now, bool is_empty) const {
  if (!m_plan) return false;
  return (m_plan->at && now >= *m_plan->at) || (m_plan->when_empty && is_empty);
}

std::string ShutdownScheduler::sentence() const {
  if (!m_plan) return {};
  if (!m_plan->sentence.empty()) return m_plan->sentence;
  return m_plan->is_restart ? "The server is restarting. Your client reconnects automatically."
                            : "The server is shutting down.";
}

std::optional<std::string> ShutdownScheduler::popNotice(Time now) {
  if (!m_plan || (m_plan->at && now >= *m_plan->at)) return std::nullopt;
  if (!std::exchange(m_announced, true)) return notice(now);
  if (m_final_notice_given || *m_plan->at - now > kFinalNotice) return std::nullopt;
  m_final_notice_given = true;
  return notice(now);
}

std::string ShutdownScheduler::notice(Time now) const {
  const std::string what = m_plan->is_restart ? "The server restarts" : "The server shuts down";
  const std::string then = m_plan->is_restart ? " Your client reconnects automatically." : "";
  if (m_plan->at_round_end) return what + " when this round is over." + then;
  if (m_plan->when_empty && m_plan->at)
    return what + " when all players have left, or " + inSeconds(*m_plan->at, now) + " at the latest." + then;
  if (m_plan->when_empty) return what + " when all players have left." + then;
  return what + " " + (m_plan->at ? inSeconds(*m_plan->at, now) : "soon") + "." + then;
}

}  // namespace naiad
