#include "Suite.h"

namespace bench {

namespace {

// Made by the first suite that registers, whichever that is.
std::map<std::string, const Suite*>& registry() {
  static std::map<std::string, const Suite*> s_suites;
  return s_suites;
}

}  // namespace

Suite::Suite(const std::string& name, const std::string& summary, Run its_run)
    : m_summary(summary), m_run(its_run) {
  registry()[name] = this;
}

const std::map<std::string, const Suite*>& Suite::all() {
  return registry();
}

}  // namespace bench
