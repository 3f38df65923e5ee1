way = recording.signal("truth/robot/distance").values[-1]
mean_speed = way / recording.ended_s
