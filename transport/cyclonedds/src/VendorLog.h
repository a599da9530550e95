// Distributes the vendor's messages by domain. The process has one sink of the vendor's, which this takes
// when the first session opens. If no session is open, messages go to standard error, as the vendor does it.
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
    // From now on the vendor's lines about that domain go to `log`.
    static void Follow(dds_domainid_t domain, std::shared_ptr<SessionLog> log);
    // Ends Follow.
    static void Leave(dds_domainid_t domain);
};

// Takes the vendor's lines on this thread as long as it lives; one per thread at a time. For calls that can
// fail: the vendor's return value is less specific than its lines.
class VendorLogCapture
{
public:
    VendorLogCapture();
    ~VendorLogCapture();
    VendorLogCapture(const VendorLogCapture &) = delete;
    VendorLogCapture &operator=(const VendorLogCapture &) = delete;
    // The vendor's first line, or "". Its warning about the element Deaf, which is ours (DomainConfig.cpp),
    // is left out.
    const std::string &FirstLine() const { return _firstLine; }
    void Add(const std::string &line);

private:
    std::string _firstLine;
};

}  // namespace Rabit::Cyclone
