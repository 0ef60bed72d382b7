// Takes the detours of the search's lattice out of a path: shortest sequence of connections between its own poses.
#pragma once

#include "tools/oracle/pose_search.hpp"

namespace rover::oracle {

// Of the same start, and of an end within the tolerance of the goal; never longer.
Pieces shortened(const Pieces& path, const SearchProblem& problem);

}  // namespace rover::oracle
