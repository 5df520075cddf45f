// One measurement, as one line on stdout: `suite key=value …`. Keys are lower case and end with the unit,
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
  /// Adds a number with four significant digits.
  Line& add(const std::string& key, double value);
  /// Adds `equal=1` if all engines that ran agree. Otherwise adds `equal=0`, and the program will exit with
  /// an error.
  Line& addEqual(bool equal);
  /// Adds a number of errors. If it is not 0, the program will exit with an error.
  Line& addZero(const std::string& key, long long errors);

 private:
  std::string m_text;
};

/// Call before the first Line. Reserves stdout for Lines and redirects other output, for example of
/// libraries, to stderr (Chipmunk prints a banner).
void reserveStdout();

/// True if no Line so far had addEqual(false), or addZero() with errors.
bool allEqual();

/// Prints a progress message on stderr.
void progress(const std::string& what);

}  // namespace bench
