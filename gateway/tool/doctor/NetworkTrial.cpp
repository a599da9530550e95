#include "doctor/NetworkTrial.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "doctor/NetworkChecks.h"
#include "doctor/RtpsCall.h"
#include "doctor/UdpSocket.h"

namespace Rabit::Tool::Doctor
{
namespace
{

// Limits of the memory that senders of datagrams can take.
constexpr std::size_t MostAddresses = 256;
constexpr std::size_t MostNames = 64;
constexpr std::size_t MostParticipants = 1024;
// Participants that are called alone. Each call takes some 190 bytes.
constexpr std::size_t MostCalledAlone = 64;

// At 20 % loss each way, one of 1000 participants answers none of seven calls.
constexpr int Calls = 7;
constexpr std::chrono::milliseconds BetweenCalls{800};
// After the first call, with so many others goes a sealed one, if no node is heard by then.
constexpr int SealedCalls = 3;

// Participants of this machine that are called at the loopback address, as ROS 2 does; and the
// calls from one of them to the next. Nothing is lost on the way.
constexpr int MostOnLoopback = 32;
constexpr int BetweenLoopbackCalls = 3;
constexpr const char *LoopbackAddress = "127.0.0.1";

sockaddr_in AddressOf(const std::string &address, int port)
{
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    return to;
}

std::string TextOf(const in_addr &address)
{
    char text[INET_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET, &address, text, sizeof text);
    return text;
}

UdpSocket OpenSocket(const std::string &address, int port)
{
    UdpSocket socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const int on = 1;
    // Shares the port with the participants that listen there.
    socket.Set(SOL_SOCKET, SO_REUSEADDR, on);
    socket.Set(SOL_SOCKET, SO_REUSEPORT, on);
    socket.Set(IPPROTO_IP, IP_PKTINFO, on);
    const sockaddr_in own = AddressOf(address, port);
    if (socket.IsOpen() && ::bind(socket.Get(), reinterpret_cast<const sockaddr *>(&own), sizeof own) == 0)
    {
        return socket;
    }
    return UdpSocket(-1);
}

int PortOf(const UdpSocket &socket)
{
    sockaddr_in own{};
    socklen_t size = sizeof own;
    ::getsockname(socket.Get(), reinterpret_cast<sockaddr *>(&own), &size);
    return ntohs(own.sin_port);
}

ip_mreqn OnInterface(int index)
{
    ip_mreqn request{};
    ::inet_pton(AF_INET, CallGroup, &request.imr_multiaddr);
    request.imr_ifindex = index;
    return request;
}

void Join(const UdpSocket &socket, const std::vector<Interface> &interfaces)
{
    const int off = 0;
    socket.Set(IPPROTO_IP, IP_MULTICAST_ALL, off);
    for (const Interface &one : interfaces)
    {
        socket.Set(IPPROTO_IP, IP_ADD_MEMBERSHIP, OnInterface(one.Index));
    }
}

// Returns the error; empty if it was sent.
std::string Send(const UdpSocket &socket, const std::string &address, int port,
                 const std::vector<std::uint8_t> &bytes)
{
    const sockaddr_in to = AddressOf(address, port);
    const bool sent =
        ::sendto(socket.Get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr *>(&to),
                 sizeof to) == static_cast<ssize_t>(bytes.size());
    return sent ? "" : std::generic_category().message(errno);
}

struct Datagram
{
    std::vector<std::uint8_t> Bytes;
    std::string From;
    int Interface = 0;  // on which it came in
};

std::optional<Datagram> Receive(const UdpSocket &socket)
{
    std::array<std::uint8_t, 65536> bytes;
    alignas(cmsghdr) std::array<char, 256> control{};
    sockaddr_in from{};
    iovec part{bytes.data(), bytes.size()};
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = ::recvmsg(socket.Get(), &message, 0);
    if (size < 0)
    {
        return std::nullopt;
    }
    Datagram datagram{{bytes.begin(), bytes.begin() + size}, TextOf(from.sin_addr), 0};
    for (cmsghdr *header = CMSG_FIRSTHDR(&message); header != nullptr; header = CMSG_NXTHDR(&message, header))
    {
        if (header->cmsg_level == IPPROTO_IP && header->cmsg_type == IP_PKTINFO)
        {
            in_pktinfo info{};
            std::memcpy(&info, CMSG_DATA(header), sizeof info);
            datagram.Interface = info.ipi_ifindex;
        }
    }
    return datagram;
}

}  // namespace

class NetworkTrial::Work
{
public:
    Work(const std::vector<Interface> &used, const std::vector<Interface> &unused, std::string ownName,
         const std::vector<int> &callIn, const std::vector<int> &listenIn, std::size_t ownSealedSessions)
        : _interfaces(used),
          _unused(unused),
          _ownName(std::move(ownName)),
          _domain(callIn.empty() ? -1 : callIn.front()),
          _ownSealedSessions(ownSealedSessions),
          _end(::eventfd(0, EFD_CLOEXEC))
    {
        std::random_device random;
        std::generate(_id.begin(), _id.end(), [&random] { return static_cast<std::uint8_t>(random()); });
        for (const Interface &one : _interfaces)
        {
            _facts.Trials[one.Name];
        }
        AddEars(listenIn);
        AddMouths();
        for (Mouth &mouth : _mouths)
        {
            std::string &error = _facts.Trials[_interfaces[mouth.Interface].Name].Error;
            error = Send(_ears[mouth.Ear].Where, CallGroup, _trialPort, TrialOn(mouth.Interface));
            for (const int domain : callIn)
            {
                error = error.empty() ? Call(mouth, domain, 0) : error;
            }
        }
        CallOnLoopback(0);
        _thread = std::thread([this] { Listen(); });
    }

    ~Work()
    {
        const std::uint64_t one = 1;
        static_cast<void>(::write(_end.Get(), &one, sizeof one));
        _thread.join();
    }

    NetworkFacts Facts() const
    {
        const std::lock_guard lock(_mutex);
        NetworkFacts facts = _facts;
        for (const auto &[participant, place] : _elsewhere)
        {
            if (!_onUsed.contains(participant))
            {
                AddTo(facts.Elsewhere[place.Domain][place.Interface], place.Address, MostAddresses);
            }
        }
        for (const auto &[participant, label] : _onLoopback)
        {
            if (!_onUsed.contains(participant) && !_answered.contains(participant) &&
                !_elsewhere.contains(participant))
            {
                AddTo(facts.OnLoopbackAlone, label, MostNames);
            }
        }
        return facts;
    }

private:
    // A socket, and the kind of datagrams that come there.
    struct Ear
    {
        UdpSocket Where;
        int Domain = -1;          // announcements of that domain
        std::string Interface{};  // answers to what was sent there; both unset: this machine's own multicast
        bool IsIgnored = false;
        bool IsLoopback = false;  // answers to what was sent to the loopback address
    };

    // How to send on an interface: sockets of _ears.
    struct Mouth
    {
        std::size_t Interface;  // in _interfaces
        std::size_t Ear;        // for calls by multicast and their answers
        std::size_t AloneEar;   // for calls to one participant alone
    };

    // A participant that was heard and has not answered.
    struct Unanswered
    {
        std::size_t Interface;
        std::string Address;
        int Port;
    };

    struct Place
    {
        int Domain = 0;
        std::string Interface;
        std::string Address;
    };

    void AddEars(const std::vector<int> &domains)
    {
        _ears.push_back({OpenSocket("0.0.0.0", 0)});
        Join(_ears.back().Where, _interfaces);
        _trialPort = PortOf(_ears.back().Where);
        for (const int domain : domains)
        {
            UdpSocket socket = OpenSocket("0.0.0.0", CallPort(domain));
            if (socket.IsOpen())
            {
                Join(socket, _interfaces);
                Join(socket, _unused);
                _ears.push_back({std::move(socket), domain});
            }
        }
    }

    void AddMouths()
    {
        for (std::size_t i = 0; i < _interfaces.size(); ++i)
        {
            const Interface &one = _interfaces[i];
            if (one.Addresses.empty())
            {
                continue;
            }
            UdpSocket socket = OpenSocket(one.Addresses.front(), 0);
            UdpSocket alone = OpenSocket(one.Addresses.front(), 0);
            if (!socket.IsOpen() || !alone.IsOpen() ||
                !socket.Set(IPPROTO_IP, IP_MULTICAST_IF, OnInterface(one.Index)))
            {
                _facts.Trials[one.Name].Error = std::generic_category().message(errno);
                continue;
            }
            _mouths.push_back({i, _ears.size(), _ears.size() + 1});
            _ears.push_back({std::move(socket), -1, one.Name});
            _ears.push_back({std::move(alone), -1, "", true});
        }
        if (UdpSocket loopback = OpenSocket(LoopbackAddress, 0); loopback.IsOpen() && _domain >= 0)
        {
            _loopbackEar = _ears.size();
            _ears.push_back({std::move(loopback), -1, "", false, true});
        }
    }

    // Announces a participant on the interface, so that answers tell on which interface it was heard. Each
    // call has a participant of its own, as participants answer newcomers. Returns the error, or nothing.
    std::string Call(const Mouth &mouth, int domain, int number) const
    {
        const UdpSocket &socket = _ears[mouth.Ear].Where;
        return Send(socket, CallGroup, CallPort(domain), CallFrom(mouth, socket, number));
    }

    std::vector<std::uint8_t> CallFrom(const Mouth &mouth, const UdpSocket &socket, int number) const
    {
        ParticipantId id = _id;
        id[id.size() - 2] = static_cast<std::uint8_t>(number);
        id.back() = static_cast<std::uint8_t>(mouth.Interface);
        std::array<std::uint8_t, 4> address{};
        ::inet_pton(AF_INET, _interfaces[mouth.Interface].Addresses.front().c_str(), address.data());
        return MakeCall(id, address, static_cast<std::uint16_t>(PortOf(socket)));
    }

    // Calls again on all interfaces. Errors were told by the first call. If it was in vain, nodes with keys
    // may be there.
    void CallAgain(int number)
    {
        const bool isSealedToo = number <= SealedCalls && !IsAnyNodeHeard();
        for (const Mouth &mouth : _mouths)
        {
            static_cast<void>(Call(mouth, _domain, number));
            const UdpSocket &alone = _ears[mouth.AloneEar].Where;
            if (isSealedToo)
            {
                static_cast<void>(
                    Send(_ears[mouth.Ear].Where, CallGroup, CallPort(_domain), MakeSealedCall()));
            }
            for (const auto &[participant, place] : _unanswered)
            {
                if (place.Interface == mouth.Interface)
                {
                    static_cast<void>(
                        Send(alone, place.Address, place.Port, CallFrom(mouth, alone, Calls + number)));
                }
            }
        }
    }

    bool IsAnyNodeHeard() const
    {
        const std::lock_guard lock(_mutex);
        return IsNodeHeard(_facts, _domain, _ownSealedSessions);
    }

    void CallOnLoopback(int number) const
    {
        if (!_loopbackEar)
        {
            return;
        }
        const UdpSocket &socket = _ears[*_loopbackEar].Where;
        ParticipantId id = _id;
        id[id.size() - 2] = static_cast<std::uint8_t>(2 * Calls + number);
        id.back() = 0;
        const auto call = MakeCall(id, {127, 0, 0, 1}, static_cast<std::uint16_t>(PortOf(socket)));
        for (int index = 0; index < MostOnLoopback; ++index)
        {
            static_cast<void>(Send(socket, LoopbackAddress, AlonePort(_domain, index), call));
        }
    }

    std::vector<std::uint8_t> TrialOn(std::size_t interface) const
    {
        std::vector<std::uint8_t> bytes(_id.size() + 1);
        std::ranges::copy(_id, bytes.begin());
        bytes.back() = static_cast<std::uint8_t>(interface);
        return bytes;
    }

    void Listen()
    {
        std::vector<pollfd> waits{{_end.Get(), POLLIN, 0}};
        for (const Ear &ear : _ears)
        {
            waits.push_back({ear.Where.Get(), POLLIN, 0});
        }
        using Clock = std::chrono::steady_clock;
        int called = _domain < 0 ? Calls : 1;
        auto callAt = Clock::now() + BetweenCalls;
        const auto timeout = [&]() -> int
        {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(callAt - Clock::now()).count();
            return called >= Calls ? -1 : static_cast<int>(std::max<decltype(left)>(left, 0));
        };
        while (::poll(waits.data(), waits.size(), timeout()) >= 0 || errno == EINTR)
        {
            if (waits.front().revents != 0)
            {
                return;
            }
            if (called < Calls && Clock::now() >= callAt)
            {
                if (called % BetweenLoopbackCalls == 0)
                {
                    CallOnLoopback(called);
                }
                CallAgain(called++);
                callAt = Clock::now() + BetweenCalls;
            }
            for (std::size_t i = 0; i < _ears.size(); ++i)
            {
                if (waits[i + 1].revents == 0)
                {
                    continue;
                }
                if (const auto datagram = Receive(_ears[i].Where))
                {
                    const std::lock_guard lock(_mutex);
                    Take(_ears[i], *datagram);
                }
            }
        }
    }

    void Take(const Ear &ear, const Datagram &datagram)
    {
        const auto on =
            std::find_if(_interfaces.begin(), _interfaces.end(),
                         [&datagram](const Interface &one) { return one.Index == datagram.Interface; });
        if (ear.IsIgnored)
        {
            return;
        }
        if (ear.Domain < 0 && ear.Interface.empty() && !ear.IsLoopback)
        {
            for (std::size_t i = 0; i < _interfaces.size(); ++i)
            {
                if (datagram.Bytes == TrialOn(i) && on != _interfaces.end())
                {
                    _facts.Trials[_interfaces[i].Name].HeardOn.insert(on->Name);
                }
            }
            return;
        }
        if (const auto session = SealedTagIn(datagram.Bytes))
        {
            if (ear.Domain >= 0 && on != _interfaces.end())
            {
                TakeSealed(ear.Domain, datagram.From, *session);
            }
            return;
        }
        const auto heard = HeardIn(datagram.Bytes);
        // Ignores the participants that this program makes itself, here and with DDS.
        if (!heard || !heard->Announces || heard->Name == _ownName ||
            std::equal(_id.begin(), _id.end() - 2, heard->Sender.begin()))
        {
            return;
        }
        if (ear.IsLoopback)
        {
            if (!heard->IsNode && _onLoopback.size() < MostParticipants)
            {
                _onLoopback[heard->Sender] = LabelOf(*heard);
            }
            return;
        }
        if (ear.Domain < 0)
        {
            if (_answered.size() < MostParticipants)
            {
                _answered.insert(heard->Sender);
            }
            AddTo(_facts.Trials[ear.Interface].AnsweredFrom, datagram.From, MostAddresses);
            _unanswered.erase(heard->Sender);
            return;
        }
        if (on == _interfaces.end())
        {
            TakeElsewhere(ear.Domain, datagram, heard->Sender);
            return;
        }
        if (_onUsed.size() < MostParticipants)
        {
            _onUsed.insert(heard->Sender);
        }
        MulticastTrial &trial = _facts.Trials[on->Name];
        if (ear.Domain == _domain)
        {
            AddTo(trial.HeardFrom, datagram.From, MostAddresses);
            // Not to another address than its own: that would send this machine's datagrams anywhere.
            if (heard->Port != 0 && !trial.AnsweredFrom.contains(datagram.From) &&
                _unanswered.size() < MostCalledAlone)
            {
                const auto interface = static_cast<std::size_t>(on - _interfaces.begin());
                _unanswered.try_emplace(heard->Sender, Unanswered{interface, datagram.From, heard->Port});
            }
        }
        auto &voices = _facts.Domains[ear.Domain];
        if (voices.size() < MostAddresses || voices.contains(datagram.From))
        {
            Voices &from = voices[datagram.From];
            from.AreNodes = from.AreNodes || heard->IsNode;
            AddTo(from.Names, LabelOf(*heard), MostNames);
        }
    }

    // Nodes with keys send no other datagrams.
    void TakeSealed(int domain, const std::string &address, std::uint32_t session)
    {
        auto &voices = _facts.Domains[domain];
        if (voices.size() < MostAddresses || voices.contains(address))
        {
            Voices &from = voices[address];
            if (from.SealedSessions.size() < MostNames)
            {
                from.SealedSessions.insert(session);
            }
        }
    }

    void TakeElsewhere(int domain, const Datagram &datagram, const ParticipantId &sender)
    {
        const auto on =
            std::find_if(_unused.begin(), _unused.end(),
                         [&datagram](const Interface &one) { return one.Index == datagram.Interface; });
        if (on != _unused.end() && _elsewhere.size() < MostParticipants)
        {
            _elsewhere.try_emplace(sender, Place{domain, on->Name, datagram.From});
        }
    }

    static void AddTo(std::set<std::string> &set, const std::string &text, std::size_t most)
    {
        if (set.size() < most)
        {
            set.insert(text);
        }
    }

    const std::vector<Interface> _interfaces;
    const std::vector<Interface> _unused;
    const std::string _ownName;
    ParticipantId _id{};
    const int _domain;  // the configured one
    const std::size_t _ownSealedSessions;
    const UdpSocket _end;
    int _trialPort = 0;
    std::vector<Ear> _ears;
    std::vector<Mouth> _mouths;
    std::optional<std::size_t> _loopbackEar;
    std::map<ParticipantId, Unanswered> _unanswered;  // for the thread alone
    mutable std::mutex _mutex;
    NetworkFacts _facts;
    std::set<ParticipantId> _onUsed;                   // heard on an interface that is used
    std::map<ParticipantId, Place> _elsewhere;         // heard on another one
    std::set<ParticipantId> _answered;                 // what was sent by multicast
    std::map<ParticipantId, std::string> _onLoopback;  // answered at the loopback address; LabelOf each
    std::thread _thread;
};

NetworkTrial::NetworkTrial(const std::vector<Interface> &used, const std::vector<Interface> &unused,
                           std::string ownName, const std::vector<int> &callIn,
                           const std::vector<int> &listenIn, std::size_t ownSealedSessions)
    : _work(std::make_unique<Work>(used, unused, std::move(ownName), callIn, listenIn, ownSealedSessions))
{
}

NetworkTrial::~NetworkTrial() = default;

NetworkFacts NetworkTrial::Facts() const
{
    return _work->Facts();
}

}  // namespace Rabit::Tool::Doctor
