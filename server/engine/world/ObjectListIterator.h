// The name under which games include ObjectListIterator.
#pragma once

#include "ObjectList.h"  // IWYU pragma: export
