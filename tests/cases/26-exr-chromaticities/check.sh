# Red of Rec.709, and the same as XYZ to four decimals: converted, with a message for those who ask for details.
expect 0 compare "$case_dir/red_in_rec709.exr" "$case_dir/red_in_xyz.exr" --max max=0.001 -v
says "CIE XYZ"
# The same from Radiance: 0.4123, 0.2130, 0.0193 are 211, 109, 10 over 512.
printf '#?RADIANCE\nPRIMARIES=1 0 0 1 0 0 .3333 .3333\n\n-Y 1 +X 1\n\323\155\012\177' >xyz.hdr
printf 'PF\n1 1\n-1\n\000\000\200\077\000\000\000\000\000\000\000\000' >red.pfm
expect 0 compare red.pfm xyz.hdr --max max=0.01
# Invalid primaries give one warning, and the colors stay unchanged.
printf '#?RADIANCE\nPRIMARIES=.3 .3 .3 .3 .3 .3 .3333 .3333\n\n-Y 1 +X 1\n\200\000\000\201' >none.hdr
expect 0 compare red.pfm none.hdr --max differing=0
says "do not form a color space"
