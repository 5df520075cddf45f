// A named group of measurements. A suite is a source file that registers itself:
//
//     const Suite suite("sweep", "swept moves against Box2D's", [](const Options& options) { … });
//
// It prints its measurements as Lines and nothing else on stdout.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bench {

struct Options {
  bool quick = false;  ///< small worlds and short measurements, to test that the suite works
};

class Suite {
 public:
  using Run = void (*)(const Options&);

  /// `name` is the first word of the suite's lines.
  Suite(const std::string& name, const std::string& summary, Run its_run);

  const std::string& summary() const { return m_summary; }
  void run(const Options& options) const { m_run(options); }

  /// Returns all suites by name.
  static const std::map<std::string, const Suite*>& all();

 private:
  std::string m_summary;
  Run m_run;
};

/// Returns the comma-separated names in an environment variable; `all` if it is not set.
std::vector<std::string> namesFrom(const char* variable, const std::vector<std::string>& all);

/// Runs a program of the build that prints `suite key=value …`, and prints its output as Lines. If a line has
/// `failed` with a value other than 0, naiad_bench also exits with an error. Returns the program's exit code.
int printLinesOf(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace bench
