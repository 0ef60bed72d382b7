// Rows of a campaign that nobody drove: rock area x slope x direction at two levels.
#pragma once

#include <vector>

#include "tools/campaign/job.hpp"
#include "tools/campaign/row.hpp"

namespace rover::campaign {

struct MadeUp {
  int seeds = 20;
  // 0: the first version; above: detours and failures that become fewer by this ratio.
  double improvement = 0.0;
};
// The same worlds, and so the same infeasible drives, for each improvement.
std::vector<Row> made_up_rows(const MadeUp& what);
// The jobs of these rows.
std::vector<Job> made_up_jobs(const std::vector<Row>& rows);

}  // namespace rover::campaign
