// Includes LogManager and, as in the published engine, utility.h.
#pragma once

#include "detail/LogManager.h"
#include "utility.h"
