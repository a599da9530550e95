#pragma once

#include <cstdint>
#include <string>

#include "backfill/Ledger.h"

namespace Rabit::Backfill
{

// Reads from the recordings of that node in a folder which posts of other nodes are in them: all that
// SeriesStreams has written in files with log times after `since`. Returns false if the ledger may lack
// posts that are there, since a part cannot be read now.
bool ReadLedger(const std::string &folder, const std::string &node, std::uint64_t since, Ledger &ledger);

}  // namespace Rabit::Backfill
