// Pages that a build makes from a program's table of options: for man, for shells, and for who writes its
// file of --config. `PROGRAM --option-page KIND` prints one (parseOptions()), so that they cannot differ from
// what the program takes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/options/Options.h"

namespace naiad {

/// KIND: "man" (the sections OPTIONS, NOTES and EXIT STATUS of a page for man, in roff), "bash", "zsh",
/// "fish" (completions), "settings" (what a file of --config may say, in roff), "config" (such a file: each
/// line a default, commented out). Nothing for another KIND.
std::optional<std::string> optionPage(std::string_view kind, const Program& program,
                                      const std::vector<Option>& options);

/// The text in roff, as the pages for man have it.
std::string roff(std::string_view text);

/// "name = value": what the option is now, as a line for the file of --config, in quotes where it takes some.
/// A comment for a secret.
std::string configLine(const Option& option);

/// Is it set by such a file, too? What has no variable is for the command line alone.
bool isSetting(const Option& option);

}  // namespace naiad
