// A family of measurements with a name. A suite is one source file that registers itself:
//
//     const Suite suite("sweep", "swept moves against Box2D's", [](const Options& options) { … });
//
// It prints its measurements as Lines and keeps stdout to itself.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bench {

struct Options {
  bool quick = false;  ///< small worlds and short measurements: does it work, rather than how fast is it
};

class Suite {
 public:
  using Run = void (*)(const Options&);

  /// `name` is the first word of the suite's lines.
  Suite(const std::string& name, const std::string& summary, Run its_run);

  const std::string& summary() const { return m_summary; }
  void run(const Options& options) const { m_run(options); }

  /// All there are, by name.
  static const std::map<std::string, const Suite*>& all();

 private:
  std::string m_summary;
  Run m_run;
};

/// What a variable of the environment lists, separated by commas; `all` if it is not set.
std::vector<std::string> namesFrom(const char* variable, const std::vector<std::string>& all);

struct Ending {
  int code = 0;         ///< exit code
  bool silent = false;  ///< it has printed nothing
};
/// Runs a program of the build that prints `suite key=value …`, and prints that as Lines. A `failed` other
/// than 0 makes naiad_bench fail, too.
Ending printLinesOf(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace bench
