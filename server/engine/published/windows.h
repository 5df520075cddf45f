// The same in the other spelling: on Windows upper and lower case are one.
#pragma once

#include "Windows.h"
