#pragma once

#include <rabit/transport/Transport.h>

#include <memory>

#include "Entity.h"
#include "common/SessionLog.h"

namespace Rabit::Cyclone
{

// What the vendor calls a domain: sockets, threads, discovery and a configuration. Each session has its own.
class VendorDomain
{
public:
    // Throws TransportError. What the vendor says of the domain goes to the log.
    VendorDomain(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log);
    ~VendorDomain();
    VendorDomain(const VendorDomain &) = delete;
    VendorDomain &operator=(const VendorDomain &) = delete;

    // The number by which this process's vendor knows it; not that of the network.
    dds_domainid_t Id() const { return _id; }

private:
    dds_domainid_t _id = 0;
    void *_watch = nullptr;  // of what it sends
    const std::shared_ptr<SessionLog> _log;
    Entity _entity;
};

}  // namespace Rabit::Cyclone
