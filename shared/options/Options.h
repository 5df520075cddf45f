// The table of a program's options, which feeds its command line, its environment and its --help.
//
// A program lists its options as values, in the order of --help; parseOptions() does the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace naiad {

/// The name that `typed` is the beginning of or takes the fewest changes to become: a character inserted,
/// left out, replaced, or two swapped. Empty if that would be more than a third of it.
std::string nearestName(const std::string& typed, const std::vector<std::string>& names);

/// Misspelt variables of the environment would be ignored without notice. A sentence for each variable that
/// begins with `prefix` and is none of `known`, with the nearest of these. `p_environment`: entries
/// NAME=VALUE, and a null at the end.
std::vector<std::string> complainOfUnknownVariables(const char* const* p_environment,
                                                    const std::string& prefix,
                                                    const std::vector<std::string>& known);

/// Stores a text; returns what is wrong with it, or nothing.
using StoreText = std::function<std::string(const std::string& text)>;

/// Where the value of an option goes. A bool makes it a flag without a value.
using OptionTarget = std::variant<bool*, int*, std::int64_t*, double*, std::string*, std::filesystem::path*,
                                  std::optional<double>*, std::optional<std::uint32_t>*,
                                  std::optional<std::uint64_t>*, StoreText>;

/// The values that a number may have.
struct OptionRange {
  double least = 0;
  double most = 0;
};

struct Option {
  std::string name;  ///< "--port"; without dashes: a required argument
  OptionTarget target;
  std::string help;
  std::string environment{};           ///< variable that sets it, too; empty: none
  std::optional<OptionRange> range{};  ///< none: any number
  std::vector<std::string> one_of{};   ///< what a text may be; empty: anything
  std::string type{};                  ///< of the value, for --help; empty: by the target
  std::string excludes{};              ///< name of an earlier option that must not be given as well
  bool shows_default = false;          ///< --help says what the target holds before parsing
  std::string default_text{};          ///< what --help says instead
  bool hidden = false;                 ///< not in --help
  bool is_secret = false;              ///< its value is never printed
  bool is_optional = false;            ///< of an argument: it need not be there
  bool joins = false;                  ///< of a text: may be given several times, which a blank joins
  bool* p_given = nullptr;             ///< becomes true if the option was given
  bool* p_from_environment = nullptr;  ///< becomes true if the variable gave it
  std::string* p_place = nullptr;      ///< becomes "FILE:LINE" if the file of --config gave it
};

/// One whose value is of this type, as --help names it: "FILE".
inline Option typedOption(std::string name, std::string type, OptionTarget target, std::string help) {
  Option option{std::move(name), std::move(target), std::move(help)};
  option.type = std::move(type);
  return option;
}

struct Program {
  std::string name;         ///< "dfserver"
  std::string purpose;      ///< the first line of --help
  std::string footer;       ///< the end of --help
  bool has_config = false;  ///< --config FILE gives options, too
};

/// What --help says of --config.
inline constexpr const char* kConfigHelp = "Read options from this file (lines like: port = 9876)";

enum class Parsed {
  kRun,
  kDone,        ///< --help, --version or --option-page (OptionPages.h): printed
  kUsageError,  ///< wrong usage: printed
};

/// Store the options from the command line, the environment and the file of --config, in this order of
/// precedence. Prints help, version and usage errors: these on stderr, with the program's name in front, the
/// file and line of each one in the file, and the nearest name where one is not known.
Parsed parseOptions(const Program& program, const std::vector<Option>& options, int argc,
                    const char* const* argv);
/// What the program ends with after that: 0, or 2 for wrong usage. Nothing if it is to run.
std::optional<int> exitCodeOf(Parsed parsed);

/// The same while a program runs: nothing is printed. Throws OptionError.
void readOptions(const Program& program, const std::vector<Option>& options, int argc,
                 const char* const* argv);

/// An option is not known, or has a value that makes no sense; what() is a sentence that names it.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Store this value of the option. Throws OptionError, which begins with `place`: where the value stands.
void storeValue(const Option& option, const std::string& value, const std::string& place);

/// The target of `to`, which has the same type, gets what the target of `from` holds.
void copyValue(const Option& from, const Option& to);

/// The value that the option's target holds, as text.
std::string currentValue(const Option& option);

}  // namespace naiad
