#include "PictureStore.h"

#include <utility>

namespace Ground
{

bool PictureStore::Put(const std::string &node, std::vector<std::uint8_t> jpeg)
{
    if (jpeg.size() < 4 || jpeg.size() > MaxBytes || jpeg[0] != 0xFF || jpeg[1] != 0xD8 || jpeg[2] != 0xFF)
        return false;
    auto picture = std::make_shared<const std::vector<std::uint8_t>>(std::move(jpeg));
    const std::lock_guard lock(_mutex);
    if (_pictures.size() >= MaxNodes && !_pictures.contains(node))
        return false;
    _pictures[node].swap(picture);
    return true;
}

PictureStore::Jpeg PictureStore::Get(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _pictures.find(node);
    return found == _pictures.end() ? nullptr : found->second;
}

}  // namespace Ground
