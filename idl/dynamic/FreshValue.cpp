#include "dynamic/FreshValue.h"

namespace Rabit::Dynamic
{

void PutFresh(CdrBuilder &out, const Part &part)
{
    if (!part.HasDefault)
    {
        PutFresh(out, *part.Type);
    }
    else if (part.Type->What == Kind::String)
    {
        out.PutString(part.DefaultText);
    }
    else
    {
        out.Put(part.DefaultNumber, part.Type->Size);
    }
}

void PutFresh(CdrBuilder &out, const Shape &shape)
{
    switch (shape.What)
    {
        case Kind::String:
            out.PutString("");
            return;
        case Kind::Sequence:
            out.Put(0, 4);
            return;
        case Kind::Array:
            for (std::uint32_t i = 0; i < shape.Length; ++i)
            {
                PutFresh(out, *shape.Element);
            }
            return;
        case Kind::Struct:
            for (const Part &part : shape.Parts)
            {
                PutFresh(out, part);
            }
            return;
        case Kind::Union:
            out.Put(static_cast<std::uint64_t>(shape.Parts.front().Label), shape.Discriminator->Size);
            PutFresh(out, *shape.Parts.front().Type);
            return;
        default:
            out.Put(shape.Start, shape.Size);
    }
}

}  // namespace Rabit::Dynamic
