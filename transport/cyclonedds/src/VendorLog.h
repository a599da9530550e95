// What the vendor says, by domain. The vendor has one sink for the whole process, which this takes when the
// first session opens; what concerns no session of ours goes to standard error, as it would without it.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>

#include "common/SessionLog.h"

namespace Rabit::Cyclone
{

class VendorLog
{
public:
    // From now on the vendor's lines about that domain go to the log.
    static void Follow(dds_domainid_t domain, std::shared_ptr<SessionLog> log);
    // No more. Returns the last error that the vendor has told of the domain, or "".
    static std::string Leave(dds_domainid_t domain);
};

}  // namespace Rabit::Cyclone
