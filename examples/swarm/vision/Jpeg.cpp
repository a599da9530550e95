// jpeglib.h needs <cstdio> before it.
#include <cstdio>

#include <jpeglib.h>

#include "Picture.h"

#include <csetjmp>
#include <cstdlib>

namespace Swarm
{
namespace
{
// By default the library ends the process on an error; this handler jumps back to Compress.
struct Errors
{
    jpeg_error_mgr Manager;
    std::jmp_buf Back;
};

void GoBack(j_common_ptr info)
{
    std::longjmp(reinterpret_cast<Errors *>(info->err)->Back, 1);  // Manager is its first member
}

void SayNothing(j_common_ptr) {}

// Only C between setjmp and longjmp: no object here has a destructor.
bool Compress(const std::uint8_t *rgb, std::size_t width, std::size_t height, int quality,
              unsigned char **jpeg, unsigned long *size)
{
    jpeg_compress_struct info{};
    Errors errors{};
    info.err = jpeg_std_error(&errors.Manager);
    errors.Manager.error_exit = GoBack;
    errors.Manager.output_message = SayNothing;
    if (setjmp(errors.Back) != 0)
    {
        jpeg_destroy_compress(&info);
        return false;
    }
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, jpeg, size);
    info.image_width = static_cast<JDIMENSION>(width);
    info.image_height = static_cast<JDIMENSION>(height);
    info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height)
    {
        JSAMPROW row = const_cast<JSAMPROW>(rgb + info.next_scanline * width * 3);
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    return true;
}
}  // namespace

std::vector<std::uint8_t> EncodeJpeg(const Image &image, int quality)
{
    if (image.Rgb.size() != image.Width * image.Height * 3)
        return {};
    unsigned char *jpeg = nullptr;
    unsigned long size = 0;
    std::vector<std::uint8_t> bytes;
    if (Compress(image.Rgb.data(), image.Width, image.Height, quality, &jpeg, &size))
        bytes.assign(jpeg, jpeg + size);
    std::free(jpeg);
    return bytes;
}

}  // namespace Swarm
