// Registration of neighbouring clouds in the GA SLAM authors' field data (31 rover clouds from Teide).
#pragma once

#include <string>

namespace rover::slam::study {

// Prints a table, or one line if the data are missing. False if too few clouds converge.
bool teide_study(const std::string& folder);

}  // namespace rover::slam::study
