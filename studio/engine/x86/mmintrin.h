// Eigen reads this header of x86 before the others and uses nothing of it.
#pragma once
