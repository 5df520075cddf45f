// An answer as lines for people.
#pragma once

#include <string>
#include <vector>

#include "shared/admin/AdminAnswer.h"

namespace naiad {

/// The sentence; facts as "name: value"; rows under a line of headings, in columns. Control characters are
/// escaped: names and reasons come from strangers.
std::vector<std::string> answerText(const AdminAnswer& answer);

/// "yes", "3", "0.25" or the text itself.
std::string valueText(const AdminValue& value);

}  // namespace naiad
