// Colours and fonts of all pictures of the report.
#pragma once

namespace rover::report::palette {

inline constexpr char kInk[] = "#1d2329";
inline constexpr char kMuted[] = "#66707a";
inline constexpr char kFaint[] = "#d9dee3";
inline constexpr char kTruth[] = "#1458b8";
inline constexpr char kEstimate[] = "#f08a24";
inline constexpr char kGlobalPath[] = "#ffffff";
inline constexpr char kRepair[] = "#8e2fb5";
inline constexpr char kOracle[] = "#0b5d2a";
inline constexpr char kHazard[] = "#e02020";
inline constexpr char kHole[] = "#00838f";
inline constexpr char kRock[] = "#3d2b20";
inline constexpr char kPebble[] = "#6d5444";
inline constexpr char kGood[] = "#1f8a4c";
inline constexpr char kBad[] = "#c62828";
inline constexpr char kFont[] = "Inter,'Helvetica Neue',Helvetica,Arial,'DejaVu Sans',sans-serif";
// Six wheels, FL FR ML MR RL RR: left in blues, right in warm colours.
inline constexpr const char* kWheels[6] = {"#0d47a1", "#bf360c", "#1e88e5", "#f4511e", "#64b5f6", "#ffb74d"};

}  // namespace rover::report::palette
