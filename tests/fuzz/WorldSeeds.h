// Seeds of what is said to worlds, by them, and of what a journal keeps of both.
#pragma once

#include "SeedFolder.h"

namespace naiad::fuzz {

/// For the target `world`.
void worlds(Folder folder);
/// For the target `round`.
void rounds(Folder folder);

}  // namespace naiad::fuzz
