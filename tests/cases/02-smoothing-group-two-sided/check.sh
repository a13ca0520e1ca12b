# A bent sheet in one smoothing group, modeled once and once each way round: both look alike from the front.
for how in auto smooth; do
    expect 0 render "$case_dir/one-sided-s1.obj" -o one.png --size 96 --normals $how
    expect 0 render "$case_dir/two-sided-s1.obj" -o two.png --size 96 --normals $how
    expect 0 compare one.png two.png --max flip=0.001,max=0.01
done
expect 0 convert "$case_dir/one-sided-s1.obj" one.glb
expect 0 convert "$case_dir/two-sided-s1.obj" two.glb
expect 0 render one.glb -o one.png --size 96
expect 0 render two.glb -o two.png --size 96
expect 0 compare one.png two.png --max flip=0.001,max=0.01
