gz service -s /world/lidar_room/control --timeout 5000 \
    --reqtype gz.msgs.WorldControl --reptype gz.msgs.Boolean \
    --req 'pause: false'
