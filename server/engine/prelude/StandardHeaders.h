// The headers of the standard library that games of the published engine expect its headers to include. Those
// of C are there in both spellings (stdlib.h, cstdlib), because games call rand() and std::rand() alike.
#pragma once

// NOLINTBEGIN(modernize-deprecated-headers)
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
// NOLINTEND(modernize-deprecated-headers)

#include <algorithm>
#include <array>
#include <cassert>
#include <cfloat>
#include <chrono>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <list>
#include <map>
#include <memory>
#include <queue>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "Microsoft.h"
