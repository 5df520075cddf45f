// Pages that the build makes from a program's table of options: for man, for shells, and for authors of
// --config files. `PROGRAM --option-page KIND` prints one (parseOptions()), so they match the program.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/options/Options.h"

namespace naiad {

/// Returns the page of this kind: "man" (the sections OPTIONS, NOTES and EXIT STATUS of a man page, in roff),
/// "bash", "zsh", "fish" (completions), "settings" (the settings of a --config file, in roff), "config" (an
/// example file: each line a default, commented out). Returns nullopt for other kinds.
std::optional<std::string> optionPage(std::string_view kind, const Program& program,
                                      const std::vector<Option>& options);

/// Escapes the text for roff.
std::string roff(std::string_view text);
/// Returns the text in single quotes for a Bourne shell.
std::string inShellQuotes(std::string_view text);

/// Returns "name = value" with the option's current value, as a line for the --config file, in quotes where
/// needed. A secret that is set becomes a comment without its value.
std::string configLine(const Option& option);

/// True if a --config file can set the option: it has an environment variable and is not hidden.
bool isSetting(const Option& option);

}  // namespace naiad
