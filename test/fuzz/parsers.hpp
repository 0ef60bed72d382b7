// Parsers of user files.
#pragma once

#include "run_inputs.hpp"

namespace rover::fuzz {

// Each with a corpus of small valid files, from corpus/NAME or generated.
Parser scenario_parser();   // a scenario
Parser settings_parser();   // the files of config/, and ground.yaml
Parser arguments_parser();  // --set, --bus, --seeds, places and paths
Parser maps_parser();       // elevation models
Parser kitti_parser();      // data sets for import
Parser euroc_parser();
Parser calibration_parser();  // files of calibration tools
Parser logs_parser();         // for replay, export, repair, spy and report
Parser requests_parser();     // HTTP requests of the page

std::vector<Parser> all_parsers();

}  // namespace rover::fuzz
