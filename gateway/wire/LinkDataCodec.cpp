#include "wire/LinkDataCodec.h"

#include <rabit/idl/CdrReader.h>
#include <rabit/idl/CdrSizer.h>
#include <rabit/idl/CdrWriter.h>
#include <rabit/idl/GeneratedMessageType.h>

#include <cstring>
#include <new>
#include <string_view>

namespace Rabit::LinkDataCodec
{
namespace
{

using Idl::CdrReader;
using Idl::CdrSizer;
using Idl::CdrWriter;

// Of the smallest item: flags, alignment, ttl_left, an empty type and an empty payload.
constexpr std::size_t SmallestItem = 18;

bool PutName(CdrWriter &writer, std::string_view name)
{
    return name.size() <= LinkMaxName &&
           (name.empty() || std::memchr(name.data(), 0, name.size()) == nullptr) &&
           writer.PutLength(name.size() + 1) && writer.PutArray(name.data(), name.size()) &&
           writer.Put(std::uint8_t{0});
}

bool PutItem(CdrWriter &writer, const LinkItem &item)
{
    return writer.Put(item.Flags) && writer.Put(item.TtlLeft) && PutName(writer, item.Type) &&
           writer.PutLength(item.Payload.size()) && writer.PutArray(item.Payload.data(), item.Payload.size());
}

bool PutData(CdrWriter &writer, const LinkData &data)
{
    if (!(writer.Put(data.Version) && PutName(writer, data.Source) && PutName(writer, data.Destination) &&
          PutName(writer, data.Queue) && writer.Put(data.SenderIncarnation) &&
          writer.Put(data.ReceiverIncarnation) && writer.Put(data.Base) && writer.Put(data.First) &&
          writer.Put(data.Echo.Clock) && writer.Put(data.Echo.Time) && writer.Put(data.Echo.HeldFor) &&
          writer.Put(data.SentAt) && data.Items.size() <= LinkMaxItems &&
          writer.PutLength(data.Items.size())))
    {
        return false;
    }
    for (const LinkItem &item : data.Items)
    {
        if (!PutItem(writer, item))
        {
            return false;
        }
    }
    return true;
}

bool GetItem(CdrReader &reader, LinkItem &item)
{
    std::size_t size = 0;
    return reader.Get(item.Flags) && reader.Get(item.TtlLeft) && reader.GetString(LinkMaxName, item.Type) &&
           reader.GetLength(0, 1, size) && reader.GetBytes(size, item.Payload);
}

bool GetData(CdrReader &reader, LinkData &data)
{
    std::size_t items = 0;
    if (!(reader.Get(data.Version) && reader.GetString(LinkMaxName, data.Source) &&
          reader.GetString(LinkMaxName, data.Destination) && reader.GetString(LinkMaxName, data.Queue) &&
          reader.Get(data.SenderIncarnation) && reader.Get(data.ReceiverIncarnation) &&
          reader.Get(data.Base) && reader.Get(data.First) && reader.Get(data.Echo.Clock) &&
          reader.Get(data.Echo.Time) && reader.Get(data.Echo.HeldFor) && reader.Get(data.SentAt) &&
          reader.GetLength(LinkMaxItems, SmallestItem, items)))
    {
        return false;
    }
    data.Items.resize(items);
    for (LinkItem &item : data.Items)
    {
        if (!GetItem(reader, item))
        {
            return false;
        }
    }
    return true;
}

}  // namespace

std::size_t EncodedSize(const LinkData &data)
{
    constexpr std::size_t Numbers = 8;  // of eight bytes each
    CdrSizer sizer;
    sizer.Add(1);
    sizer.AddString(data.Source.size());
    sizer.AddString(data.Destination.size());
    sizer.AddString(data.Queue.size());
    sizer.Add(8, Numbers);
    sizer.Add(4);
    for (const LinkItem &item : data.Items)
    {
        sizer.Add(1);
        sizer.Add(8);
        sizer.AddString(item.Type.size());
        sizer.Add(4);
        sizer.Add(1, item.Payload.size());
    }
    return Idl::SampleSize(sizer.Used());
}

bool Encode(const LinkData &data, std::span<std::uint8_t> buffer)
{
    if (buffer.size() < Idl::EncapsulationSize)
    {
        return false;
    }
    try
    {
        CdrWriter writer(buffer.subspan(Idl::EncapsulationSize));
        if (!PutData(writer, data) || Idl::SampleSize(writer.Used()) != buffer.size())
        {
            return false;
        }
        Idl::WriteEncapsulation(buffer, writer.PadToWord());
        return true;
    }
    catch (const eprosima::fastcdr::exception::Exception &)
    {
        return false;
    }
}

bool Decode(SampleBytes bytes, LinkData &data)
{
    std::span<const std::uint8_t> body;
    bool littleEndian = true;
    if (!Idl::OpenSample(bytes, body, littleEndian))
    {
        return false;
    }
    try
    {
        CdrReader reader(body, littleEndian);
        return GetData(reader, data) && reader.Left() <= Idl::MaxPadding;
    }
    catch (const eprosima::fastcdr::exception::Exception &)
    {
        return false;
    }
    catch (const std::bad_alloc &)
    {
        return false;
    }
}

}  // namespace Rabit::LinkDataCodec
