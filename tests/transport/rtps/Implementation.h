// A DDS implementation as far as discovery goes: it announces itself, believes the announcements of others,
// and tells its endpoints to each participant that it knows. It repairs what was lost (OMG DDSI-RTPS 2.3,
// 8.5).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/RtpsWriter.h"
#include "guard/RtpsBytes.h"
#include "rtps/DiscoverySubmessages.h"

class Implementation
{
public:
    using Bytes = RtpsBytes::Bytes;
    using Prefix = Rabit::Rtps::GuidPrefix;
    using EntityId = Rabit::Rtps::EntityId;

    Implementation(const Prefix &name, std::function<void(const Bytes &)> send)
        : _name(name), _send(std::move(send))
    {
    }

    void AddWriter(EntityId entity)
    {
        Add(Rabit::Rtps::PublicationsWriter, entity, RtpsBytes::WriterData(entity, _name));
    }
    // With further parameters in the announcement.
    void AddWriter(EntityId entity, const Bytes &parameters)
    {
        Bytes data = RtpsBytes::WriterData(entity, _name);
        data.insert(data.end() - 4, parameters.begin(), parameters.end());  // before the sentinel
        Add(Rabit::Rtps::PublicationsWriter, entity, std::move(data));
    }
    void Announce() { _send(RtpsBytes::ParticipantMessage(_name)); }
    // Sends a heartbeat to each peer that has not acknowledged everything. Call it once a second.
    void Tick()
    {
        for (auto &[peer, known] : _peers)
        {
            Beat(peer, known);
        }
    }
    // Receives a message from the network, or one that Meeting delivers.
    void Receive(std::span<const std::uint8_t> message)
    {
        const Prefix from = Rabit::Rtps::SenderOf(message);
        if (from == _name)
        {
            return;
        }
        Rabit::Rtps::VisitSubmessages(message,
                                      [&](const Rabit::Rtps::ConstSubmessage &part)
                                      {
                                          const auto said = Rabit::Rtps::ReadAnnouncement(part.Whole);
                                          if (said && said->Writer == Rabit::Rtps::ParticipantWriter)
                                          {
                                              said->Alive ? Meet(from)
                                                          : static_cast<void>(_peers.erase(from));
                                          }
                                      });
        const auto parts = Rabit::Rtps::ReadEndpointSubmessages(message);
        const auto found = _peers.find(from);
        if (parts && found != _peers.end())
        {
            for (const auto &part : *parts)
            {
                if (part.To == _name || part.To == Prefix{})
                {
                    Take(from, found->second, part);
                }
            }
        }
    }
    bool Knows(const Prefix &peer) const { return _peers.contains(peer); }
    bool KnowsAny() const { return !_peers.empty(); }
    // Returns the known endpoints of this peer.
    std::set<EntityId> EndpointsOf(const Prefix &peer) const
    {
        std::set<EntityId> endpoints;
        const auto found = _peers.find(peer);
        if (found != _peers.end())
        {
            const auto writers = found->second.Heard.find(Rabit::Rtps::PublicationsWriter);
            for (const auto &[number, entity] :
                 writers == found->second.Heard.end() ? Numbers{} : writers->second)
            {
                endpoints.insert(entity);
            }
        }
        endpoints.erase(0);
        return endpoints;
    }
    bool IsAcknowledgedBy(const Prefix &peer) const
    {
        const auto found = _peers.find(peer);
        return found != _peers.end() && found->second.Acknowledged > Last();
    }

private:
    using Numbers = std::map<std::int64_t, EntityId>;  // 0: will not come
    struct Peer
    {
        std::map<EntityId, Numbers> Heard;  // by the announcing writer
        std::int64_t Acknowledged = 1;
    };

    std::int64_t Last() const { return static_cast<std::int64_t>(_said.size()); }
    void Add(EntityId /*writer*/, EntityId entity, Bytes data)
    {
        _said.emplace_back(entity, std::move(data));
        for (auto &[peer, known] : _peers)
        {
            Say(peer, Last());
            Beat(peer, known);
        }
    }
    Bytes To(const Prefix &peer) const
    {
        Bytes message = RtpsBytes::Header(_name);
        Rabit::Rtps::AppendDestination(message, peer);
        return message;
    }
    void Say(const Prefix &peer, std::int64_t number)
    {
        const Bytes &data = _said[static_cast<std::size_t>(number - 1)].second;
        const Bytes body = RtpsBytes::DataBody(number, data, Rabit::Rtps::PublicationsWriter);
        _send(RtpsBytes::Join({To(peer), RtpsBytes::Submessage(RtpsBytes::Data, body, 0x05)}));
    }
    void Beat(const Prefix &peer, const Peer &known)
    {
        if (known.Acknowledged <= Last())
        {
            Bytes message = To(peer);
            Rabit::Rtps::AppendHeartbeat(message, Rabit::Rtps::PublicationsWriter, Last(), ++_count);
            _send(message);
        }
    }
    void Meet(const Prefix &peer)
    {
        const auto [found, isNew] = _peers.try_emplace(peer);
        if (isNew)
        {
            for (std::int64_t number = 1; number <= Last(); ++number)
            {
                Say(peer, number);
            }
            Beat(peer, found->second);
        }
    }
    void Take(const Prefix &peer, Peer &known, const Rabit::Rtps::EndpointSubmessage &part)
    {
        using Rabit::Rtps::SubmessageKind;
        Numbers &heard = known.Heard[part.Said.Writer];
        if (part.Kind == SubmessageKind::Data)
        {
            const EntityId subject = Rabit::Rtps::SubjectOf(part.Whole);
            for (auto &[number, entity] : heard)
            {
                entity = entity == subject ? 0 : entity;
            }
            heard[part.Said.First] = part.Said.Alive ? subject : 0;
        }
        else if (part.Kind == SubmessageKind::Gap)
        {
            for (const std::int64_t number : part.Gone)
            {
                heard.emplace(number, EntityId{0});
            }
        }
        else if (part.Kind == SubmessageKind::Heartbeat)
        {
            Bytes message = To(peer);
            std::int64_t base = 1;
            std::vector<std::int64_t> missing;
            while (heard.contains(base))
            {
                ++base;
            }
            for (std::int64_t number = base; number <= part.Said.Last; ++number)
            {
                if (!heard.contains(number))
                {
                    missing.push_back(number);
                }
            }
            Rabit::Rtps::AppendAcknowledgement(message, part.Said.Writer, base, missing, ++_count);
            _send(message);
        }
        else if (part.Kind == SubmessageKind::AckNack && part.Said.Writer == Rabit::Rtps::PublicationsWriter)
        {
            known.Acknowledged = part.Said.First;
            for (std::int64_t number = part.Said.First; number <= std::min(part.Said.Last, Last()); ++number)
            {
                Say(peer, number);
            }
        }
    }

    const Prefix _name;
    const std::function<void(const Bytes &)> _send;
    std::vector<std::pair<EntityId, Bytes>> _said;
    std::map<Prefix, Peer> _peers;
    std::uint32_t _count = 0;
};
