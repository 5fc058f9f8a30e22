# SPDX-License-Identifier: BSD-3-Clause
# Draws the work over time during a rotation: gnuplot -e "data='timeline.txt'; image='timeline.png'" timeline.gp
# data: the output of `stream_latency --table timeline`.
set terminal pngcairo size 1100,420 font "DejaVu Sans,11"
set output image
set xlabel "milliseconds since the first turn began (10 turns a second)"
set xrange [0:*]
set yrange [-0.1:3.4]
unset ytics
set ytics ("PCL, whole turn" 0.4, "voxel grid, whole turn" 1.4, "Lisco, column by column" 2.4) scale 0
set border 1
set grid noytics noxtics
set style fill solid 1.0 noborder
set arrow from 100,graph 0 to 100,3.3 nohead dashtype 2 linecolor "#808080"
set arrow from 200,graph 0 to 200,3.3 nohead dashtype 2 linecolor "#808080"
set label "first turn complete " at 100,3.2 right textcolor "#606060"
set label " second turn complete" at 200,3.2 left textcolor "#606060"
# The colours of the other charts.
color(name) = name eq "pcl" ? 0x000000 : name eq "grid" ? 0x0072B2 : 0xD55E00
lane(name) = name eq "pcl" ? 0 : name eq "grid" ? 1 : 2
# Boxes as high as the share of working time, on the base line of each lane.
plot data using (($2 + $3) / 2):(lane(strcol(1)) + 0.4 * $4):2:3:(lane(strcol(1))): \
       (lane(strcol(1)) + 0.8 * ($4 > 1 ? 1 : $4)):(color(strcol(1))) with boxxyerror linecolor rgb variable notitle
