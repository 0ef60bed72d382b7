// The GA SLAM authors' field data (31 rover clouds of a walk on Teide): do they register with one another?
#pragma once

#include <string>

namespace rover::slam::study {

// Prints a table; a line that says so where the data are not there. False where too few clouds converge.
bool teide_study(const std::string& folder);

}  // namespace rover::slam::study
