# Motion, pairs, friction, statics. `motion_scene.h` is shared by all of them.
function(motion_test name label)
  trackbed_test(${name} ${label} trackbed_dem)
  target_include_directories(${name}_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
endfunction()

motion_test(motion_rotation verification)
motion_test(motion_impact verification)
motion_test(sphere_impact verification)
motion_test(dilated_contact verification)
target_include_directories(dilated_contact_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/verification)
trackbed_test(ball_features verification trackbed_dem)
motion_test(flat_contact verification)
target_include_directories(flat_contact_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/verification)
motion_test(clump_contact unit)
motion_test(union_contact verification)
motion_test(statics_block hard)
motion_test(motion_pile hard)
motion_test(motion_impacts hard)
motion_test(pairs_friction unit)
motion_test(pairs_resistance unit)
motion_test(motion_damping unit)
motion_test(motion_together unit)
motion_test(pairs_candidates unit)
motion_test(pairs_shares unit)

add_library(settled_bed STATIC ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/settled_bed.cc)
target_include_directories(settled_bed PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks
                           ${CMAKE_CURRENT_SOURCE_DIR}/unit)
target_link_libraries(settled_bed PUBLIC trackbed_dem)
add_executable(motion_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/motion_benchmark.cc)
target_link_libraries(motion_benchmark PRIVATE settled_bed)
add_executable(bed_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/bed_benchmark.cc)
target_link_libraries(bed_benchmark PRIVATE settled_bed)

# The bed of the benchmarks, in tests.
trackbed_test(bed_threads hard settled_bed)
motion_test(bed_quiet slow)

add_executable(shapes_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/shapes_benchmark.cc
               ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/bed_file.cc)
target_link_libraries(shapes_benchmark PRIVATE trackbed_dem)
target_include_directories(shapes_benchmark PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
