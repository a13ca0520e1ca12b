# irot 1 turns the stored 64 x 32 texels anticlockwise by 90 degrees: the two sizes differ.
expect 4 compare "$case_dir/plain.png" "$case_dir/irot1.avif"
says "32 x 64"
