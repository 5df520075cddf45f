// Includes ObjectListIterator under the name that games use.
#pragma once

#include "ObjectList.h"  // IWYU pragma: export
