#pragma once

#include "LinkContext.h"
#include "LinkReceiver.h"
#include "LinkSender.h"
#include "PeerToken.h"

#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace Rabit
{

// One other node: its life, its token, the hellos to it, and the links to and from it. A node's life and
// clock are the same for all its links, so what one link learns of them holds for all.
class LinkPeer
{
public:
    using Senders = std::map<std::string, std::unique_ptr<LinkSender>, std::less<>>;
    using Receivers = std::map<std::string, std::unique_ptr<LinkReceiver>, std::less<>>;

    LinkPeer(LinkContext &context, std::string name, LinkTime now);

    // The life in which this node is to the peer.
    std::uint64_t OwnLife() const { return _ownLife; }
    // The life that the peer is in as far as known; 0: not heard yet.
    std::uint64_t Incarnation() const { return _incarnation; }

    // The peer says, or a message of its shows, that it is in this life. Rule S5: a higher one than known is
    // a restart, all streams to it start anew; a lower one is old, or the peer has lost its storage and must
    // be told by a hello. Returns whether it is the life known now.
    bool HeardOf(std::uint64_t incarnation, LinkTime now);
    // A reading of the peer's clock came, from its present life. Rule S4: the newest becomes the token.
    void TakeToken(std::uint64_t clock, std::int64_t time, LinkTime now);
    // A hello has come.
    void OnHello(const LinkHello &hello, LinkTime now);
    // Sends a hello as soon as HelloGap allows.
    void HelloSoon(LinkTime now);

    // Whether nothing is lost with it but what can be learnt again: nothing waits for it here.
    bool MayBeForgotten() const { return !HasPending(); }
    bool HasLinks() const { return !_senders.empty() || !_receivers.empty(); }
    bool IsSilentAt(LinkTime now) const { return now - _heardAt >= _context.Settings.SilentAfter; }
    LinkTime HeardAt() const { return _heardAt; }

    // Rules R1 and S6: this node has taken a new incarnation.
    void OnOwnRaise(LinkTime now);

    LinkSender *FindSender(std::string_view queue) const;
    LinkReceiver *FindReceiver(std::string_view queue) const;
    // Makes a link. There must be none for that queue.
    LinkSender &AddSender(std::string_view queue, const LinkOptions &options);
    LinkReceiver &AddReceiver(std::string_view queue);
    const Senders &AllSenders() const { return _senders; }
    const Receivers &AllReceivers() const { return _receivers; }

    // A message was enqueued for the peer: a silent one is called.
    void OnEnqueued(LinkTime now);
    void Run(LinkTime now);
    LinkTime NextDue() const;
    std::string Describe() const;

private:
    PeerView View() const { return {_name, _incarnation, _token, _silent}; }
    bool HasPending() const;
    void HeardNow(LinkTime now);
    void RunHello(LinkTime now);
    LinkTime NextHelloStep();

    LinkContext &_context;
    const std::string _name;
    std::uint64_t _ownLife;
    std::uint64_t _incarnation = 0;
    PeerToken _token;
    LinkTime _heardAt;     // when something of its present life came last; at first, when it was made
    bool _silent = false;  // not heard for SilentAfter
    LinkTime _helloAt;
    LinkTime _helloStep;                // until the hello after the next, while a token is wanted
    LinkTime _lastHelloAt = LinkNever;  // LinkNever: none was sent
    Senders _senders;
    Receivers _receivers;
};

}  // namespace Rabit
