#pragma once

#include <httplib.h>

// It brings <resolv.h>, whose macro _res is a parameter of Eigen's, which is included after it.
#undef _res
