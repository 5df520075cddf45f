// One measurement, as one line on stdout: `suite key=value …`. Keys are lower case with the unit in the name,
// values have no blanks, numbers no exponents.
#pragma once

#include <string>

namespace bench {

class Line {
 public:
  explicit Line(const std::string& suite) : m_text(suite) {}
  /// Prints the line.
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  Line& add(const std::string& key, const std::string& value);
  Line& add(const std::string& key, long long value);
  Line& add(const std::string& key, int value) { return add(key, static_cast<long long>(value)); }
  /// With four significant digits.
  Line& add(const std::string& key, double value);
  /// `equal=1` if all engines that ran agree, else `equal=0`; then the program fails in the end.
  Line& addEqual(bool equal);
  /// A number of errors: if it is not 0, the program fails in the end.
  Line& addZero(const std::string& key, long long errors);

 private:
  std::string m_text;
};

/// Call it before the first Line: stdout belongs to Lines from then on, and what libraries print there goes
/// to stderr (Chipmunk introduces itself).
void reserveStdout();

/// Has every line so far that compared engines found them equal, and no errors?
bool allEqual();

/// A word to whoever waits, on stderr.
void progress(const std::string& what);

}  // namespace bench
