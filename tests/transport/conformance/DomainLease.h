// A DDS domain for a test that uses the machine's network.
#pragma once

namespace Rabit::Conformance
{

// A DDS domain that no other test program in this network namespace has, as long as the object lives. Throws
// std::runtime_error if all are taken.
class DomainLease
{
public:
    DomainLease();
    ~DomainLease();
    DomainLease(const DomainLease &) = delete;
    DomainLease &operator=(const DomainLease &) = delete;
    int Domain() const { return _domain; }

private:
    int _domain = 0;
    int _lease = -1;  // a socket
};

// The domain of this test program, which it has until it ends. Throws as DomainLease does.
inline int OwnDomain()
{
    static const DomainLease own;
    return own.Domain();
}

}  // namespace Rabit::Conformance
