// The part of World that logs.

#include "engine/world/LogFile.h"
#include "engine/world/Settings.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

void World::log(const std::string& line) const {
  if (m_log_sink) {
    m_log_sink(line);
  } else {
    writeToLogFile(m_p_extras != nullptr ? m_p_extras->settings.logfile : LOGFILE_DEFAULT, line, m_log_flush);
  }
}

void World::refuse(const std::string& type, const char* what) {
  ++m_refusals;
  if (!m_refused.insert(type).second) return;
  log("Refused a number that is not finite or out of range: " + std::string(what) + ", object of type " +
      type + " (further ones of this type are only counted)");
}

}  // namespace df
