// Completions of shells, from a program's table of options (OptionPages.h).
#pragma once

#include <string>
#include <vector>

#include "shared/options/Options.h"

namespace naiad {

/// Does it stand alone, without a value?
bool isFlag(const Option& option);

/// What --help shows, --help, --version and --config among it, in its order.
std::vector<Option> shownOptions(const Program& program, const std::vector<Option>& options);

/// Files for bash's, zsh's and fish's folders of completions. They complete the names of options, values that
/// are one of a few words, and files.
std::string bashCompletion(const Program& program, const std::vector<Option>& options);
std::string zshCompletion(const Program& program, const std::vector<Option>& options);
std::string fishCompletion(const Program& program, const std::vector<Option>& options);

}  // namespace naiad
