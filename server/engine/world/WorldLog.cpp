#include "engine/world/WorldLog.h"

#include <cstring>

#include "engine/world/ActivityPage.h"
#include "engine/world/LogFile.h"
#include "engine/world/Settings.h"

namespace df {

namespace {

/// Maximum number of different lines of writeOnce(), so that a game with many names does not fill memory.
constexpr std::size_t kMaxLogged = 500;

/// Returns which values a setter would have accepted.
const char* rightFor(const char* what) {
  struct Rule {
    const char* what;
    const char* right;
  };
  static constexpr Rule kRules[] = {
      {"setAltitude", "an altitude is 0 to 4"},
      {"setSolidness", "a solidness is HARD, SOFT or SPECTRAL"},
      {"setMass", "a mass is finite and above 0"},
      {"setControls", "a table of controls has known keys and finite speeds"},
      {"setText", "a text's id is 0 to 15, and the text begins inside the window"},
      {"setSize", "a window has 20 to 400 by 10 to 150 characters"},
  };
  for (const Rule& rule : kRules) {
    if (std::strcmp(rule.what, what) == 0) return rule.right;
  }
  return "a number is not finite (a division by 0?) or out of range";
}

}  // namespace

void WorldLog::write(const std::string& line) const {
  if (m_p_page != nullptr) m_p_page->addLine(line);
  if (m_sink) {
    m_sink(line);
  } else {
    writeToLogFile(m_p_file != nullptr ? *m_p_file : LOGFILE_DEFAULT, line, m_flush);
  }
}

bool WorldLog::isNew(const std::string& line) {
  return m_once.size() < kMaxLogged && m_once.insert(line).second;
}

void WorldLog::writeOnce(const std::string& line) {
  if (isNew(line)) write(line);
}

void WorldLog::addActivityLineOnce(const std::string& line) {
  if (m_p_page != nullptr && isNew(line)) m_p_page->addLine(line);
}

int WorldLog::refuse(const std::string& type, const char* what) {
  ++m_refusals;
  writeOnce("Refused: " + std::string(what) + " of " + type + ": " + rightFor(what) +
            " (further ones are only counted)");
  return -1;
}

void WorldLog::clear() {
  m_once.clear();
  m_refusals = 0;
}

}  // namespace df
