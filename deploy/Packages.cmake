# Settings with which deploy/package and CPack make four Debian packages. COMPONENT at each install() names the package of a
# file; this file has the files that only packages need, and the descriptions and dependencies of the packages.
set(debian ${CMAKE_CURRENT_SOURCE_DIR}/debian)
# This revision sorts before 1, that of an official Debian package. Packages for a newer Debian sort after those for an older one.
set(revision 0naiad1)
file(STRINGS ${debian}/changelog first LIMIT_COUNT 1)
if(NOT first MATCHES "^naiad \\(${PROJECT_VERSION}-${revision}\\)")
  message(FATAL_ERROR "deploy/debian/changelog begins with \"${first}\", but the version is ${PROJECT_VERSION}-${revision}")
endif()
cmake_host_system_information(RESULT debian_version QUERY DISTRIB_VERSION_ID)
string(APPEND revision "+deb${debian_version}")
set(version ${PROJECT_VERSION}-${revision})
set(triplet ${CMAKE_LIBRARY_ARCHITECTURE})

# Installs systemd's units and the files for its users, folders and settings.
set(systemd ${CMAKE_CURRENT_SOURCE_DIR}/systemd)
install(FILES ${systemd}/dfserver@.service ${systemd}/dfserver@.socket ${systemd}/dfweb.service ${systemd}/dfdir.service
  DESTINATION /lib/systemd/system COMPONENT server)
install(FILES ${systemd}/sysusers.conf DESTINATION lib/sysusers.d RENAME naiad-server.conf COMPONENT server)
install(FILES ${systemd}/tmpfiles.conf DESTINATION lib/tmpfiles.d RENAME naiad-server.conf COMPONENT server)
install(FILES ${pages}/default.conf ${systemd}/dfweb.env ${systemd}/dfdir.env DESTINATION /etc/naiad COMPONENT server)

# Makes and installs the changelog, the licence and the lintian overrides.
set(changelog ${pages}/changelog.Debian.gz)
add_custom_command(OUTPUT ${changelog}
  COMMAND gzip -9nc ${debian}/changelog > ${changelog} DEPENDS ${debian}/changelog)
add_custom_target(naiad_changelog ALL DEPENDS ${changelog})
foreach(component server client library dev)
  string(REGEX MATCH "server:([^;]*);client:([^;]*);library:([^;]*);dev:(.*)" _
    "server:naiad-server;client:naiad-client;library:libdragonfly0;dev:libdragonfly-dev")
  set(name_server ${CMAKE_MATCH_1})
  set(name_client ${CMAKE_MATCH_2})
  set(name_library ${CMAKE_MATCH_3})
  set(name_dev ${CMAKE_MATCH_4})
  set(package ${name_${component}})
  install(FILES ${changelog} ${debian}/copyright DESTINATION share/doc/${package} COMPONENT ${component})
  if(EXISTS ${debian}/${package}.lintian-overrides)
    install(FILES ${debian}/${package}.lintian-overrides DESTINATION share/lintian/overrides RENAME ${package}
      COMPONENT ${component})
  endif()
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME naiad)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # otherwise it would become the first line of each description
set(CPACK_PACKAGE_CONTACT "The Naiad maintainers <naiad@naiad.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL server client library dev)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${revision})
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# Programs and games are linked with libdragonfly of this build, so dpkg-shlibdeps also searches the build folder.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})

set(CPACK_DEBIAN_SERVER_PACKAGE_NAME naiad-server)
set(CPACK_DEBIAN_SERVER_PACKAGE_SECTION net)
set(CPACK_DEBIAN_SERVER_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS
  "libdragonfly0 (= ${version}), systemd | systemd-standalone-sysusers | systemd-sysusers, systemd | systemd-standalone-tmpfiles | systemd-tmpfiles")
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS "naiad-client, nats-server, openssh-server, openssl")
set(CPACK_DEBIAN_SERVER_DESCRIPTION "server for networked Dragonfly games
Naiad makes text games for the Dragonfly engine playable over a network.
The server runs the game and shows it to players in terminals and browsers.

This package has the server (dfserver), the gateway and page for browsers
(dfweb), the program of an ssh door (dfdoor), replay of recorded rounds
(dfreplay), the directory of a fleet (dfdir), ten games, and units for
systemd.")
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA ${debian}/naiad-server/postinst ${debian}/naiad-server/prerm
  ${debian}/naiad-server/postrm ${debian}/naiad-server/conffiles)

set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME naiad-client)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION net)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_CLIENT_DESCRIPTION "terminal client for networked Dragonfly games
Naiad makes text games for the Dragonfly engine playable over a network.
The client draws the game of a server in a terminal, and sends keys and
mouse; it needs no files of the game.

This package has the client (dfclient), and players without a screen for
tests (dfbot).")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libdragonfly0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
# Packages of games that are linked with libdragonfly depend on exactly this version. Written here, because CPack's own list
# would contain game modules, too.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/shlibs "libdragonfly 0 libdragonfly0 (= ${version})\nlibdragonfly-physics 0 libdragonfly0 (= ${version})\nlibdragonfly-ops 0 libdragonfly0 (= ${version})\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${debian}/libdragonfly0/triggers ${CMAKE_CURRENT_BINARY_DIR}/shlibs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "engine, physics and hosting for networked text games
A text-character game engine with the interface of Dragonfly, with bodies
and joints, whose games are servers: players join them over a network.

This package has the shared library.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libdragonfly-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libdragonfly0 (= ${version}), python3:any")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "g++ | c++-compiler, naiad-client, naiad-server")
set(CPACK_DEBIAN_DEV_DESCRIPTION "engine, physics and hosting for networked text games (development)
A text-character game engine with the interface of Dragonfly, with bodies
and joints, whose games are servers: players join them over a network.

This package has headers, files for CMake and pkg-config, the sources of
ten games, dragonfly-new, which makes a small game to start from,
dragonfly-adopt, which builds and runs games written for the published
engine, and dragonfly-mark, which does this for a folder of games.")
include(CPack)
