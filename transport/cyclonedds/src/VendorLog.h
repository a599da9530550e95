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
    // No more.
    static void Leave(dds_domainid_t domain);
};

// Takes what the vendor says on this thread as long as it lives; one a thread at a time. For calls that can
// fail: the vendor's return value does not tell what a line says.
class VendorLogCapture
{
public:
    VendorLogCapture();
    ~VendorLogCapture();
    VendorLogCapture(const VendorLogCapture &) = delete;
    VendorLogCapture &operator=(const VendorLogCapture &) = delete;
    // The first line that it said, or "".
    const std::string &FirstLine() const { return _firstLine; }
    void Add(const std::string &line);

private:
    std::string _firstLine;
};

}  // namespace Rabit::Cyclone
